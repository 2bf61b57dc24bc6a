/* SPDX-License-Identifier: Apache-2.0 */
#include "capture/result.h"

#include <inttypes.h>
#include <stdio.h>

#include "cli/tables/json_output.h"

static void add_times(cJSON *root, const char *key, const latency *times)
{
    if (times->count > 0) {
        cJSON *item = cJSON_AddObjectToObject(root, key);
        cJSON_AddNumberToObject(item, "mean", latency_mean(times));
        cJSON_AddNumberToObject(item, "median", latency_of_share(times, 50));
        cJSON_AddNumberToObject(item, "most_95", latency_of_share(times, 95));
        cJSON_AddNumberToObject(item, "worst", times->worst);
    }
}

static double rate_of(const capture_account *a)
{
    return a->seconds > 0 && a->frames > 1 ? (double)(a->frames - 1) / a->seconds : 0;
}

static void print_json(const capture_options *o, const char *name, const t3r_capture *capture, const capture_account *a,
                       const clock_offset *offset)
{
    cJSON *root = cJSON_CreateObject();
    const t3r_capture_counts *n = &a->counts;
    const struct {
        const char *key;
        uint64_t value;
    } counts[] = {{"frames", a->frames},
                  {"paired", n->paired},
                  {"alone", n->alone},
                  {"dropped_driver", n->dropped_driver},
                  {"dropped_slow", n->dropped_slow},
                  {"corrupted", n->corrupted},
                  {"depth_dropped", n->depth_dropped},
                  {"faults", n->faults},
                  {"reopened", n->reopened},
                  {"failed", a->failed},
                  {"unposed", a->unposed},
                  {"files", a->files},
                  {"bytes", a->bytes}};
    cJSON_AddStringToObject(root, "source", name);
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        json_add_integer(root, counts[i].key, (int64_t)counts[i].value);
    }
    cJSON_AddNumberToObject(root, "width", a->width);
    cJSON_AddNumberToObject(root, "height", a->height);
    cJSON_AddStringToObject(root, "format", t3r_pixel_format_name(a->format));
    cJSON_AddStringToObject(root, "clock", t3r_capture_clock(capture));
    cJSON_AddStringToObject(root, "note", t3r_capture_note(capture));
    cJSON_AddNumberToObject(root, "rate", rate_of(a));
    add_times(root, "latency_ms", &a->late);
    add_times(root, "frame_ms", &a->work);
    add_times(root, "record_ms", &a->recording);
    add_times(root, "build_ms", &a->building);
    add_times(root, "write_ms", &a->writing);
    if (o->hash) {
        json_add_hash(root, "frames_hash", a->frames_hash);
    }
    if (o->poses != NULL) {
        cJSON_AddNumberToObject(root, "clock_offset_s", (double)offset->offset_ns * 1e-9);
        json_add_integer(root, "poses_left_out", (int64_t)o->poses_left_out);
    }
    if (o->estimate) {
        cJSON_AddNumberToObject(root, "clock_offset_explained", offset->explained);
    }
    if (a->builds > 0) {
        cJSON_AddStringToObject(root, "scene", o->scene);
        json_add_integer(root, o->streams ? "keyframes" : "builds", a->builds);
        json_add_integer(root, "gaussians", a->gaussians);
        json_add_integer(root, "arena_bytes", (int64_t)a->arena_bytes);
    }
    if (a->builds > 0 && !o->streams) {
        json_add_integer(root, "valid_points", a->valid_points);
        json_add_integers(root, "context", a->context, a->context_count);
    }
    if (a->scene_hash != 0) {
        json_add_hash(root, "hash", a->scene_hash);
    }
    json_print(root);
}

static void print_text(const capture_options *o, const char *name, const t3r_capture *capture, const capture_account *a,
                       const clock_offset *offset)
{
    const t3r_capture_counts *n = &a->counts;
    char text[HASH_TEXT_BYTES], spread[LATENCY_TEXT_BYTES];
    printf("%s: %" PRIu64 " frames of %ux%u %s, %.1f/s, clock %s\n", name, a->frames, a->width, a->height,
           t3r_pixel_format_name(a->format), rate_of(a), t3r_capture_clock(capture));
    printf("lost:     driver %" PRIu64 ", too slow %" PRIu64 ", corrupted %" PRIu64 ", unreadable %" PRIu64
           "; faults %" PRIu64 ", reconnects %" PRIu64 "\n",
           n->dropped_driver, n->dropped_slow, n->corrupted, a->failed, n->faults, n->reopened);
    if (n->paired + n->alone > 0) {
        printf("depth:    paired %" PRIu64 ", colour alone %" PRIu64 ", depth unused %" PRIu64 "\n", n->paired,
               n->alone, n->depth_dropped);
    }
    if (o->poses != NULL) {
        printf("poses:    %" PRIu64 " frames without; clock offset %+.6f s", a->unposed,
               (double)offset->offset_ns * 1e-9);
        if (o->estimate) {
            printf(" estimated, explains %.0f %% of the picture's motion", offset->explained * 100);
        }
        putchar('\n');
    }
    if (a->late.count > 0) {
        printf("latency:  %s\n", latency_text(&a->late, spread));
    }
    printf("a frame:  %s\n", latency_text(&a->work, spread));
    if (a->recording.count > 0) {
        printf("recorded: %s\n", latency_text(&a->recording, spread));
    }
    if (o->output != NULL) {
        printf("%s: %" PRIu64 " bytes in %" PRIu32 " file%s\n", o->output, a->bytes, a->files,
               a->files == 1 ? "" : "s");
    }
    if (a->builds > 0 && o->streams) {
        hash_text(a->scene_hash, text);
        printf("keyframe: %s; %.1f a second\n", latency_text(&a->building, spread), latency_rate(&a->building));
        printf("%s: %" PRIu32 " Gaussians after %" PRIu32 " keyframes, written in %.1f ms, arena %zu bytes, %s%s\n",
               o->scene, a->gaussians, a->builds, latency_mean(&a->writing), a->arena_bytes,
               a->scene_hash != 0 ? "hash " : "no hash: --max-ms", a->scene_hash != 0 ? text : "");
    } else if (a->builds > 0) {
        hash_text(a->scene_hash, text);
        printf("a build:  %s\n", latency_text(&a->building, spread));
        printf("%s: %" PRIu32 " Gaussians of %" PRIu32 " valid points, %" PRIu32
               " builds, written in %.1f ms, arena %zu bytes, hash %s\n",
               o->scene, a->gaussians, a->valid_points, a->builds, latency_mean(&a->writing), a->arena_bytes, text);
    }
    if (o->hash) {
        hash_text(a->frames_hash, text);
        printf("frames:   %s\n", text);
    }
}

void capture_result_print(const capture_options *o, const char *name, const t3r_capture *capture,
                          const capture_account *a, const clock_offset *offset)
{
    if (o->json) {
        print_json(o, name, capture, a, offset);
    } else if (!live_options_print_lines(&o->live)) {
        print_text(o, name, capture, a, offset);
    }
}
