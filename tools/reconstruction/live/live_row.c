/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/live/live_row.h"

#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "cli/tables/json_output.h"
#include "cli/text/style.h"

typedef enum field_kind {
    FIELD_COUNT,
    FIELD_SIGNED,
    FIELD_SHARE, /* a count; in the table percent of the points */
    FIELD_STAMP,
    FIELD_NUMBER, /* a double; NaN and infinity are null */
    FIELD_PLACE,  /* three doubles */
    FIELD_TURN,   /* four doubles */
    FIELD_DECISION,
    FIELD_STAGES,
    FIELD_HASH /* 0 is null */
} field_kind;

#define AT(field) offsetof(live_row, field)

/* A row for each field of the JSON; with a heading it is a column of the table as well. */
static const struct {
    const char *key, *heading;
    int width; /* of the column */
    field_kind kind;
    size_t offset;
    const char *unit, *meaning;
} fields[] = {
    {"frame", "frame", 7, FIELD_COUNT, AT(frame), "", "number of the frame in the source, from 0"},
    {"stamp_ns", NULL, 0, FIELD_STAMP, AT(stamp_ns), "ns", "time of the frame, by the source's clock"},
    {"decision", NULL, 0, FIELD_DECISION, AT(loss), "", "taken, or why the frame is no keyframe"},
    {"keyframe", NULL, 0, FIELD_COUNT, AT(report.keyframes), "", "number of keyframes so far"},
    {"gaussians", "Gaussians", 9, FIELD_COUNT, AT(report.gaussians), "", "Gaussians in the map"},
    {"added", "added", 7, FIELD_COUNT, AT(report.added), "", "Gaussians that the keyframe added"},
    {"removed", "removed", 8, FIELD_COUNT, AT(report.removed), "", "Gaussians that it contradicts or replaces"},
    {"crowded", "crowded", 8, FIELD_COUNT, AT(report.crowded), "", "Gaussians removed for lack of room"},
    {"points", NULL, 0, FIELD_COUNT, AT(report.points), "", "pixels with a depth, also a filled one"},
    {"shown", "shown, %", 8, FIELD_SHARE, AT(report.shown), "", "pixels of these that the map already showed"},
    {"moved", NULL, 0, FIELD_COUNT, AT(report.moved), "", "1: a new piece of the map begins, as poses jumped"},
    {"realigned", NULL, 0, FIELD_COUNT, AT(report.realigned), "", "1: the map has moved with poses that jumped"},
    {"depth_q8", NULL, 0, FIELD_COUNT, AT(report.depth_q8), "1/256", "share of pixels with a measured depth"},
    {"dark_q8", NULL, 0, FIELD_COUNT, AT(report.dark_q8), "1/256", "share of pixels below level 16"},
    {"bright_q8", NULL, 0, FIELD_COUNT, AT(report.bright_q8), "1/256", "share of pixels above level 239"},
    {"detail_q8", NULL, 0, FIELD_COUNT, AT(report.detail_q8), "1/256", "fine differences over coarse ones"},
    {"compared", NULL, 0, FIELD_COUNT, AT(report.compared), "", "Gaussians that were compared with the frame"},
    {"contradicted_q8", NULL, 0, FIELD_COUNT, AT(report.contradicted_q8), "1/256",
     "share of these that the frame sees through"},
    {"likeness_q8", NULL, 0, FIELD_COUNT, AT(report.likeness_q8), "1/256", "correlation with the others' colours"},
    {"recent", NULL, 0, FIELD_COUNT, AT(report.recent), "", "Gaussians in the picture that the last keyframe saw"},
    {"in_view_q8", NULL, 0, FIELD_COUNT, AT(report.in_view_q8), "1/256", "share of all that the last keyframe saw"},
    {"hidden_q8", NULL, 0, FIELD_COUNT, AT(report.hidden_q8), "1/256", "share of these that something near hides"},
    {"hidden_likeness_q8", NULL, 0, FIELD_COUNT, AT(report.hidden_likeness_q8), "1/256", "their likeness"},
    {"exposure_q8", NULL, 0, FIELD_SIGNED, AT(report.exposure_q8), "1/256", "stops brighter than the map"},
    {"passes", "passes", 6, FIELD_COUNT, AT(passes), "", "passes of refinement"},
    {"passes_planned", NULL, 0, FIELD_COUNT, AT(passes_planned), "", "passes without --max-ms"},
    {"ms", "ms", 8, FIELD_NUMBER, AT(milliseconds), "ms", "time that the keyframe took"},
    {"psnr_before", NULL, 0, FIELD_NUMBER, AT(psnr_before), "dB",
     "PSNR of the map's view before it; null: not measured"},
    {"position", NULL, 0, FIELD_PLACE, AT(position), "m", "place of the camera in the world: x, y, z"},
    {"rotation", NULL, 0, FIELD_TURN, AT(rotation), "", "rotation of the camera to the world: w, x, y, z"},
    {"stages_ms", NULL, 0, FIELD_STAGES, AT(stages), "ms", "time of each stage, its hashing included"},
    {"hash", NULL, 0, FIELD_HASH, AT(hash), "", "hash of all stages so far; null with --max-ms"},
};
enum { FIELDS = sizeof fields / sizeof fields[0] };

const char *live_row_decision(const live_row *row)
{
    static const char *const losses[] = {NULL, "unreadable", "no pose", "no camera_info"};
    return row->loss != LIVE_WHOLE                   ? losses[row->loss]
           : row->status != T3R_OK                   ? t3r_error_text(row->status)
           : row->report.refusal != T3R_REFUSAL_NONE ? t3r_refusal_name(row->report.refusal)
                                                     : "taken";
}

static double percent(uint32_t share_q8)
{
    return share_q8 / 2.56;
}

/* Writes the figure by which the gate refused the frame; "" without a refusal. */
static void describe(const t3r_stream_report *r, char *text, size_t bytes)
{
    text[0] = '\0';
    switch (r->refusal) {
    case T3R_REFUSAL_NONE:
        break;
    case T3R_REFUSAL_NO_DEPTH:
        snprintf(text, bytes, ": %.1f %% of the pixels have a depth", percent(r->depth_q8));
        break;
    case T3R_REFUSAL_DARK:
        snprintf(text, bytes, ": %.1f %% of the pixels are below level 16", percent(r->dark_q8));
        break;
    case T3R_REFUSAL_BRIGHT:
        snprintf(text, bytes, ": %.1f %% of the pixels are above level 239", percent(r->bright_q8));
        break;
    case T3R_REFUSAL_EXPOSURE:
        snprintf(text, bytes, ": %+.1f stops against the map", r->exposure_q8 / 256.0);
        break;
    case T3R_REFUSAL_BLURRED:
        snprintf(text, bytes, ": detail %.3f", r->detail_q8 / 256.0);
        break;
    case T3R_REFUSAL_COVERED:
        snprintf(text, bytes, ": %.1f %% of what the last keyframe saw is hidden, likeness %.2f", percent(r->hidden_q8),
                 r->hidden_likeness_q8 / 256.0);
        break;
    case T3R_REFUSAL_CONTRADICTS:
        snprintf(text, bytes, ": %.1f %% of the map is seen through, likeness %.2f of the rest",
                 percent(r->contradicted_q8), r->likeness_q8 / 256.0);
        break;
    default:
        snprintf(text, bytes, ": the camera is out of the map's range");
    }
}

static uint32_t count_at(const live_row *row, size_t offset)
{
    uint32_t value;
    memcpy(&value, (const char *)row + offset, sizeof value);
    return value;
}

static const double *numbers_at(const live_row *row, size_t offset)
{
    return (const double *)((const char *)row + offset);
}

static void add_numbers(cJSON *object, const char *key, const double *values, int count)
{
    char text[128];
    int length = 0;
    for (int i = 0; i < count; i++) {
        length += snprintf(text + length, sizeof text - (size_t)length, "%c%.9g", i == 0 ? '[' : ',', values[i]);
    }
    snprintf(text + length, sizeof text - (size_t)length, "]");
    cJSON_AddRawToObject(object, key, text);
}

static void add_number(cJSON *object, const char *key, double value)
{
    char text[40] = "null";
    if (isfinite(value)) {
        snprintf(text, sizeof text, "%.3f", value);
    }
    cJSON_AddRawToObject(object, key, text);
}

static void add_hash(cJSON *object, const char *key, uint64_t hash)
{
    if (hash != 0) {
        json_add_hash(object, key, hash);
    } else {
        cJSON_AddNullToObject(object, key);
    }
}

cJSON *live_row_json(const live_row *row)
{
    cJSON *object = cJSON_CreateObject();
    for (int i = 0; i < FIELDS; i++) {
        const char *key = fields[i].key;
        const size_t at = fields[i].offset;
        switch (fields[i].kind) {
        case FIELD_COUNT:
        case FIELD_SHARE:
            json_add_integer(object, key, count_at(row, at));
            break;
        case FIELD_SIGNED:
            json_add_integer(object, key, (int32_t)count_at(row, at));
            break;
        case FIELD_STAMP:
            json_add_integer(object, key, row->stamp_ns);
            break;
        case FIELD_NUMBER:
            add_number(object, key, *numbers_at(row, at));
            break;
        case FIELD_PLACE:
            add_numbers(object, key, numbers_at(row, at), 3);
            break;
        case FIELD_TURN:
            add_numbers(object, key, numbers_at(row, at), 4);
            break;
        case FIELD_DECISION:
            cJSON_AddStringToObject(object, key, live_row_decision(row));
            break;
        case FIELD_STAGES:
            stage_times_add_json(object, key, &row->stages);
            break;
        case FIELD_HASH:
            add_hash(object, key, row->hash);
            break;
        }
    }
    return object;
}

void live_row_headings(void)
{
    fputs(style_begin(stdout, STYLE_HEADING), stdout);
    for (int i = 0; i < FIELDS; i++) {
        if (fields[i].heading != NULL) {
            printf("%*s ", fields[i].width, fields[i].heading);
        }
    }
    printf("decision%s\n", style_end(stdout));
}

void live_row_print(const live_row *row)
{
    for (int i = 0; i < FIELDS; i++) {
        if (fields[i].heading == NULL) {
            continue;
        }
        const size_t at = fields[i].offset;
        if (fields[i].kind == FIELD_COUNT) {
            printf("%*" PRIu32 " ", fields[i].width, count_at(row, at));
        } else {
            const double share = row->report.points == 0 ? 0 : 100.0 * count_at(row, at) / row->report.points;
            printf("%*.1f ", fields[i].width, fields[i].kind == FIELD_SHARE ? share : *numbers_at(row, at));
        }
    }
    char figure[160];
    describe(&row->report, figure, sizeof figure);
    printf("%s%s\n", live_row_decision(row), figure);
}

char *live_row_help(char *text, size_t bytes)
{
    size_t length = 0;
    for (int i = 0; i < FIELDS && length < bytes; i++) {
        length += (size_t)snprintf(text + length, bytes - length, "  %-20s%s%s%s\n", fields[i].key, fields[i].unit,
                                   fields[i].unit[0] != '\0' ? ": " : "", fields[i].meaning);
    }
    return text;
}
