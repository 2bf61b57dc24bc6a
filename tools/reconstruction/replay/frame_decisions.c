/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/replay/frame_decisions.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/tables/json_output.h"

bool frame_decisions_open(frame_decisions *decisions, uint32_t frames)
{
    decisions->skipped = calloc((size_t)frames + 1, sizeof *decisions->skipped);
    return decisions->skipped != NULL;
}

void frame_decisions_close(frame_decisions *decisions)
{
    free(decisions->skipped);
    *decisions = (frame_decisions){0};
}

static skipped_frame *skip(frame_decisions *decisions, uint32_t frame, const char *reason)
{
    skipped_frame *skipped = &decisions->skipped[decisions->count++];
    *skipped = (skipped_frame){.frame = frame, .reason = reason};
    return skipped;
}

bool frame_decisions_read(frame_decisions *decisions, const t3r_recording *recording, uint32_t index,
                          t3r_capture_frame *frame)
{
    char lost[512] = "", error[512] = "";
    const int status = t3r_recording_frame_readable(recording, index, frame, lost, sizeof lost, error, sizeof error);
    const char *reason = status != T3R_CAPTURE_FRAME ? "unreadable"
                         : !frame->has_pose          ? "no pose"
                         : !frame->has_intrinsics    ? "no camera_info"
                                                     : NULL;
    if (reason != NULL) {
        skipped_frame *skipped = skip(decisions, index, reason);
        snprintf(skipped->detail, sizeof skipped->detail, "%s", status != T3R_CAPTURE_FRAME ? error : lost);
    }
    return reason == NULL;
}

static double percent(uint32_t share_q8)
{
    return share_q8 / 2.56;
}

/* Writes the figure that decided. */
static void describe(const t3r_stream_report *r, char *text, size_t bytes)
{
    switch (r->refusal) {
    case T3R_REFUSAL_NO_DEPTH:
        snprintf(text, bytes, "%.1f %% of the pixels have a depth", percent(r->depth_q8));
        break;
    case T3R_REFUSAL_DARK:
        snprintf(text, bytes, "%.1f %% of the pixels are below level 16", percent(r->dark_q8));
        break;
    case T3R_REFUSAL_BRIGHT:
        snprintf(text, bytes, "%.1f %% of the pixels are above level 239", percent(r->bright_q8));
        break;
    case T3R_REFUSAL_EXPOSURE:
        snprintf(text, bytes, "%+.1f stops against the map", r->exposure_q8 / 256.0);
        break;
    case T3R_REFUSAL_BLURRED:
        snprintf(text, bytes, "detail %.3f", r->detail_q8 / 256.0);
        break;
    case T3R_REFUSAL_COVERED:
        snprintf(text, bytes, "%.1f %% of what the last keyframe saw is hidden, likeness %.2f", percent(r->hidden_q8),
                 r->hidden_likeness_q8 / 256.0);
        break;
    case T3R_REFUSAL_CONTRADICTS:
        snprintf(text, bytes, "%.1f %% of the map is seen through, likeness %.2f of the rest",
                 percent(r->contradicted_q8), r->likeness_q8 / 256.0);
        break;
    default:
        snprintf(text, bytes, "the camera is out of the map's range");
    }
}

bool frame_decisions_took(frame_decisions *decisions, uint32_t frame, t3r_status status,
                          const t3r_stream_report *report)
{
    if (status != T3R_OK) {
        skipped_frame *skipped = skip(decisions, frame, "refused");
        snprintf(skipped->detail, sizeof skipped->detail, "%s", t3r_error_text(status));
        return false;
    }
    if (report->refusal != T3R_REFUSAL_NONE) {
        skipped_frame *skipped = skip(decisions, frame, t3r_refusal_name(report->refusal));
        skipped->report = *report;
        describe(report, skipped->detail, sizeof skipped->detail);
        return false;
    }
    return true;
}

void frame_figures_add(cJSON *item, const t3r_stream_report *r)
{
    json_add_integer(item, "depth_q8", r->depth_q8);
    json_add_integer(item, "dark_q8", r->dark_q8);
    json_add_integer(item, "bright_q8", r->bright_q8);
    json_add_integer(item, "detail_q8", r->detail_q8);
    json_add_integer(item, "compared", r->compared);
    json_add_integer(item, "contradicted_q8", r->contradicted_q8);
    json_add_integer(item, "likeness_q8", r->likeness_q8);
    json_add_integer(item, "recent", r->recent);
    json_add_integer(item, "hidden_q8", r->hidden_q8);
    json_add_integer(item, "hidden_likeness_q8", r->hidden_likeness_q8);
    json_add_integer(item, "exposure_q8", r->exposure_q8);
}

static uint32_t count_of(const frame_decisions *decisions, const char *reason)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < decisions->count; i++) {
        count += strcmp(decisions->skipped[i].reason, reason) == 0;
    }
    return count;
}

/* Whether frame i is the first with its reason. */
static bool is_first(const frame_decisions *decisions, uint32_t i)
{
    const frame_decisions before = {decisions->skipped, i};
    return count_of(&before, decisions->skipped[i].reason) == 0;
}

void frame_decisions_add(cJSON *root, const frame_decisions *decisions)
{
    cJSON *all = cJSON_AddArrayToObject(root, "skipped"), *counts = cJSON_AddObjectToObject(root, "skip_counts");
    for (uint32_t i = 0; i < decisions->count; i++) {
        const skipped_frame *s = &decisions->skipped[i];
        cJSON *item = cJSON_CreateObject();
        json_add_integer(item, "frame", s->frame);
        cJSON_AddStringToObject(item, "reason", s->reason);
        cJSON_AddStringToObject(item, "detail", s->detail);
        frame_figures_add(item, &s->report);
        cJSON_AddItemToArray(all, item);
        if (is_first(decisions, i)) {
            json_add_integer(counts, s->reason, count_of(decisions, s->reason));
        }
    }
}

void frame_decisions_print(const frame_decisions *decisions)
{
    for (uint32_t i = 0; i < decisions->count; i++) {
        const skipped_frame *s = &decisions->skipped[i];
        printf("%8" PRIu32 " skipped: %s%s%s\n", s->frame, s->reason, s->detail[0] != '\0' ? ", " : "", s->detail);
    }
    for (uint32_t i = 0; i < decisions->count; i++) {
        if (is_first(decisions, i)) {
            printf("%s%s %" PRIu32, i == 0 ? "skipped frames: " : ", ", decisions->skipped[i].reason,
                   count_of(decisions, decisions->skipped[i].reason));
        }
    }
    if (decisions->count > 0) {
        printf("\n");
    }
}
