/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/replay/replay_slide.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "api/adding.h"
#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "cli/tables/json_output.h"
#include "reconstruction/lens_masks.h"
#include "reconstruction/reconstruction_error.h"
#include "reconstruction/replay/hash_report.h"

typedef struct slide_run {
    const reconstruction_options *options;
    const t3r_recording *recording;
    const char *path;
    reconstruction r;
    uint32_t scenes;
    double *milliseconds; /* per scene except the first: frames to planes, and the build */
} slide_run;

static int add_frame(slide_run *s, uint32_t frame)
{
    t3r_capture_frame captured;
    int code = recorded_frame_read(s->recording, s->path, frame, &captured);
    if (code != CLI_OK) {
        return code;
    }
    code = lens_mask_find(&s->r, s->options, s->path, t3r_slot_of_next(s->r.runtime), &captured);
    if (code != CLI_OK) {
        return code;
    }
    t3r_status status = t3r_add_view(s->r.runtime, &captured.frame, &captured.camera);
    return status == T3R_OK ? CLI_OK : reconstruction_view_error(status, s->r.runtime, s->path, frame, &captured);
}

/* Builds the scene of the frame and the previous one. */
static int build_at(slide_run *s, uint32_t frame)
{
    int code = CLI_OK;
    const double start = cli_now();
    if (!s->r.config.warm) {
        (void)t3r_reset(s->r.runtime);
        code = add_frame(s, frame - 1);
    }
    code = code == CLI_OK ? add_frame(s, frame) : code;
    if (code != CLI_OK) {
        return code;
    }
    t3r_status status = reconstruction_make(&s->r, s->options, NULL);
    s->milliseconds[s->scenes - 1] = (cli_now() - start) * 1000;
    cli_progress_end();
    if (status != T3R_OK) {
        return reconstruction_make_error(&s->r, status, s->path);
    }
    s->scenes++;
    return CLI_OK;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print_text(const slide_run *s, double mean, double median, uint64_t hash)
{
    const reconstruction *r = &s->r;
    printf("%s: %" PRIu32 " scenes of two frames each\n%" PRIu32 " Gaussians, head %s, warm %s, arena %zu bytes\n",
           s->path, s->scenes, r->scene.count, r->head.name, r->config.warm ? "on" : "off", r->arena_bytes);
    if (s->scenes > 1) {
        printf("after the first: %.1f ms each (median %.1f), %.1f frames a second\n", mean, median, 1000 / mean);
    }
    hash_report_print(r, hash);
}

static void print_json(const slide_run *s, double mean, double median, uint64_t hash, const expectation *e,
                       const char *difference)
{
    const reconstruction *r = &s->r;
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "recording", s->path);
    cJSON_AddNumberToObject(root, "bits_epoch", T3R_BITS_EPOCH);
    json_add_integer(root, "scenes", s->scenes);
    json_add_integer(root, "width", r->config.width);
    json_add_integer(root, "height", r->config.height);
    json_add_integer(root, "gaussians", r->scene.count);
    cJSON_AddStringToObject(root, "head", r->head.name);
    cJSON_AddBoolToObject(root, "warm", r->config.warm != 0);
    json_add_integer(root, "arena_bytes", (int64_t)r->arena_bytes);
    if (s->scenes > 1) {
        cJSON_AddNumberToObject(root, "mean_ms", mean);
        cJSON_AddNumberToObject(root, "median_ms", median);
        cJSON_AddNumberToObject(root, "frames_per_second", 1000 / mean);
    }
    hash_report_add_stages(root, r);
    json_add_hash(root, "hash", hash);
    expectation_add(root, e, difference);
    json_print(root);
}

static int report(slide_run *s, bool json, const expectation *e)
{
    const uint32_t timed = s->scenes - 1;
    double sum = 0;
    for (uint32_t i = 0; i < timed; i++) {
        sum += s->milliseconds[i];
    }
    qsort(s->milliseconds, timed, sizeof *s->milliseconds, by_size);
    const double mean = timed == 0 ? 0 : sum / timed, median = timed == 0 ? 0 : s->milliseconds[timed / 2];
    const uint64_t hash = reconstruction_hash(&s->r);
    char difference[128];
    (void)expectation_missed(e, &s->r, hash, difference, sizeof difference);
    if (json) {
        print_json(s, mean, median, hash, e, difference);
    } else {
        print_text(s, mean, median, hash);
    }
    return expectation_verdict(e, s->path, hash, difference, json);
}

int replay_slide(const t3r_recording *recording, const char *path, const reconstruction_options *settings, bool json,
                 const expectation *e)
{
    const uint32_t frames = t3r_recording_frame_count(recording);
    if (frames < 2) {
        return cli_error(CLI_BAD_INPUT, "%s: a pair needs two frames", path);
    }
    reconstruction_options first = *settings;
    first.context_count = 2;
    first.context[0] = 0;
    first.context[1] = 1;
    slide_run s = {.options = settings, .recording = recording, .path = path, .scenes = 1};
    s.milliseconds = calloc(frames, sizeof *s.milliseconds);
    if (s.milliseconds == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    int code = reconstruction_build(&s.r, recording, path, &first);
    if (code == CLI_OK) {
        for (uint32_t frame = 2; frame < frames && code == CLI_OK; frame++) {
            code = build_at(&s, frame);
        }
        code = code == CLI_OK ? report(&s, json, e) : code;
        reconstruction_close(&s.r);
    }
    free(s.milliseconds);
    return code;
}
