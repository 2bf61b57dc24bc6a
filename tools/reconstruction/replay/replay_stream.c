/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/replay/replay_stream.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "cli/tables/json_output.h"
#include "cli/text/style.h"
#include "core/hash.h"
#include "pictures/metrics.h"
#include "pictures/picture.h"
#include "reconstruction/developed_frame.h"
#include "reconstruction/reconstruction_error.h"
#include "reconstruction/replay/frame_decisions.h"
#include "reconstruction/replay/hash_report.h"

#define TEXT_BYTES 4096

typedef struct keyframe {
    uint32_t frame;
    t3r_stream_report report;
    double milliseconds;
    uint64_t hash; /* of all stages so far */
} keyframe;

/* A frame that was no keyframe, drawn from the map after the next keyframe, and at the end. Frames after the last
 * keyframe are drawn only at the end. */
typedef struct held_back {
    uint32_t frame;
    bool has_live;
    double live_psnr, final_psnr; /* over pixels with depth */
    double live_psnr_all, final_psnr_all;
} held_back;

typedef struct stream_run {
    const replay_stream_options *options;
    const t3r_recording *recording;
    const char *path;
    uint32_t every;
    reconstruction r;
    uint8_t *target, *drawn, *mask;
    uint16_t *depth;
    uint64_t views_hash; /* of all pictures drawn */
    keyframe *keyframes;
    uint32_t keyframe_count;
    held_back *held;
    uint32_t held_count;
    frame_decisions decisions;
} stream_run;

/* ---- held-back frames ------------------------------------------------------------------------------------------ */

static int open_pictures(stream_run *s)
{
    const size_t pixels = (size_t)s->r.config.width * s->r.config.height;
    s->target = malloc(pixels * 3);
    s->drawn = malloc(pixels * 3);
    s->mask = malloc(pixels);
    s->depth = malloc(pixels * sizeof *s->depth);
    return s->target != NULL && s->drawn != NULL && s->mask != NULL && s->depth != NULL
               ? CLI_OK
               : cli_error(CLI_BAD_INPUT, "out of memory");
}

static int write_picture(const stream_run *s, const char *what, uint32_t frame, uint32_t channels, uint8_t *samples)
{
    char path[TEXT_BYTES], error[TEXT_BYTES + 256] = "";
    int length = snprintf(path, sizeof path, "%s/%s_%05" PRIu32 ".png", s->options->images, what, frame);
    if (length < 0 || (size_t)length >= sizeof path) {
        return cli_error(CLI_BAD_INPUT, "%s: the path is too long", s->options->images);
    }
    picture p = {
        .width = s->r.config.width, .height = s->r.config.height, .channels = channels, .bits = 8, .samples = samples};
    return picture_write_png(path, &p, error, sizeof error) == 0 ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s", error);
}

/* Draws the frame's view from the current map and compares: over pixels where the frame has a depth, and over all. */
static int draw_held(stream_run *s, uint32_t frame, const char *when, double *psnr, double *psnr_all)
{
    const uint32_t width = s->r.config.width, height = s->r.config.height;
    t3r_capture_frame captured;
    int code = recorded_frame_read(s->recording, s->path, frame, &captured);
    t3r_camera camera;
    if (code == CLI_OK) {
        code = developed_capture(&captured, s->path, frame, width, height, s->target, s->depth, &camera);
    }
    if (code != CLI_OK) {
        return code;
    }
    const t3r_target target = {.width = width, .height = height, .rgb = s->drawn, .rgb_stride_bytes = width * 3};
    const t3r_status status = t3r_render(s->r.runtime, &camera, &target);
    if (status == T3R_ERR_CAMERA) { /* out of the map's range: nothing to compare */
        *psnr = *psnr_all = NAN;
        return CLI_OK;
    }
    if (status != T3R_OK) {
        return cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 ": %s", s->path, frame, t3r_error_text(status));
    }
    size_t pixels = (size_t)width * height;
    for (size_t i = 0; i < pixels; i++) {
        s->mask[i] = captured.frame.depth != NULL && s->depth[i] != 0 ? 255 : 0;
    }
    *psnr = metric_psnr(s->target, s->drawn, s->mask, width, height);
    *psnr_all = metric_psnr(s->target, s->drawn, NULL, width, height);
    s->views_hash = t3r_hash_bytes(s->views_hash, s->drawn, pixels * 3);
    if (s->options->images == NULL) {
        return CLI_OK;
    }
    code = write_picture(s, when, frame, 3, s->drawn);
    if (code == CLI_OK) {
        code = write_picture(s, "frame", frame, 3, s->target);
    }
    return code == CLI_OK ? write_picture(s, "mask", frame, 1, s->mask) : code;
}

/* Draws the frames between the keyframe just taken and the previous one. */
static int draw_live(stream_run *s, uint32_t now)
{
    for (uint32_t i = 0; i < s->held_count; i++) {
        held_back *h = &s->held[i];
        if (h->frame < now && !h->has_live) {
            int code = draw_held(s, h->frame, "live", &h->live_psnr, &h->live_psnr_all);
            if (code != CLI_OK) {
                return code;
            }
            h->has_live = true;
        }
    }
    return CLI_OK;
}

/* ---- the run ----------------------------------------------------------------------------------------------------- */

/* Returns whether the frame became a keyframe. */
static bool take_keyframe(stream_run *s, const t3r_capture_frame *captured)
{
    keyframe *k = &s->keyframes[s->keyframe_count];
    k->frame = captured->index;
    double start = cli_now();
    t3r_status status = t3r_stream_keyframe(s->r.runtime, &captured->frame, &captured->camera, &k->report);
    k->milliseconds = (cli_now() - start) * 1000;
    cli_progress_end();
    if (!frame_decisions_took(&s->decisions, captured->index, status, &k->report)) {
        return false;
    }
    k->hash = reconstruction_hash(&s->r);
    s->keyframe_count++;
    return true;
}

/* Whether a frame is a keyframe: every so many frames, and when the overlap with the last keyframe is small. */
static bool is_keyframe(const stream_run *s, const t3r_capture_frame *captured)
{
    const uint32_t since =
        s->keyframe_count == 0 ? s->every : captured->index - s->keyframes[s->keyframe_count - 1].frame;
    uint32_t overlap_q8;
    if (since >= s->every || s->options->overlap_q8 == 0) {
        return since >= s->every;
    }
    return t3r_stream_overlap(s->r.runtime, &captured->camera, captured->frame.width, captured->frame.height,
                              &overlap_q8) == T3R_OK &&
           overlap_q8 < s->options->overlap_q8;
}

static int run(stream_run *s)
{
    uint32_t frames = t3r_recording_frame_count(s->recording);
    s->keyframes = calloc((size_t)frames + 1, sizeof *s->keyframes);
    s->held = calloc((size_t)frames + 1, sizeof *s->held);
    if (s->keyframes == NULL || s->held == NULL || !frame_decisions_open(&s->decisions, frames)) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    for (uint32_t frame = 0; frame < frames; frame++) {
        t3r_capture_frame captured;
        if (!frame_decisions_read(&s->decisions, s->recording, frame, &captured)) {
            continue;
        }
        if (!is_keyframe(s, &captured)) {
            s->held[s->held_count++].frame = frame;
            continue;
        }
        const int code = take_keyframe(s, &captured) ? draw_live(s, frame) : CLI_OK;
        if (code != CLI_OK) {
            return code;
        }
    }
    for (uint32_t i = 0; i < s->held_count; i++) {
        held_back *h = &s->held[i];
        int code = draw_held(s, h->frame, "final", &h->final_psnr, &h->final_psnr_all);
        if (code != CLI_OK) {
            return code;
        }
    }
    t3r_status status = t3r_get_scene(s->r.runtime, &s->r.scene);
    return status == T3R_OK ? CLI_OK : reconstruction_error(status, s->path, &s->r.config, s->r.arena_bytes);
}

static int write_map(const stream_run *s)
{
    char error[TEXT_BYTES] = "";
    return scene_file_write(s->options->output, &s->r.scene, 0, NULL, error, sizeof error) == 0
               ? CLI_OK
               : cli_error(CLI_BAD_INPUT, "%s", error);
}

/* ---- the report
 * ---------------------------------------------------------------------------------------------------- */

typedef struct means {
    uint32_t live_count, final_count;
    double live, live_all, final, final_all; /* means in dB; NaN without frames */
} means;

static means means_of(const stream_run *s)
{
    means m = {0};
    for (uint32_t i = 0; i < s->held_count; i++) {
        const held_back *h = &s->held[i];
        if (h->has_live && !isnan(h->live_psnr)) {
            m.live += h->live_psnr;
            m.live_all += h->live_psnr_all;
            m.live_count++;
        }
        if (!isnan(h->final_psnr)) {
            m.final += h->final_psnr;
            m.final_all += h->final_psnr_all;
            m.final_count++;
        }
    }
    m.live /= m.live_count;
    m.live_all /= m.live_count;
    m.final /= m.final_count;
    m.final_all /= m.final_count;
    return m;
}

static void add_decibels(cJSON *object, const char *key, double value)
{
    if (isnan(value) || isinf(value)) {
        cJSON_AddNullToObject(object, key);
    } else {
        cJSON_AddNumberToObject(object, key, value);
    }
}

static void print_json(const stream_run *s, uint64_t hash, const expectation *e, const char *difference)
{
    const reconstruction *r = &s->r;
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "recording", s->path);
    if (s->options->output != NULL) {
        cJSON_AddStringToObject(root, "scene", s->options->output);
    }
    cJSON_AddNumberToObject(root, "bits_epoch", T3R_BITS_EPOCH);
    json_add_integer(root, "every", s->every);
    json_add_integer(root, "overlap_q8", s->options->overlap_q8);
    json_add_integer(root, "at_hand", r->config.views);
    json_add_integer(root, "width", r->config.width);
    json_add_integer(root, "height", r->config.height);
    json_add_integer(root, "cap", r->config.gaussians);
    json_add_integer(root, "gaussians", r->scene.count);
    cJSON_AddStringToObject(root, "head", r->head.name);
    if (r->head.weights != NULL) {
        cJSON_AddStringToObject(root, "head_crc", r->head.crc);
    }
    json_add_integer(root, "arena_bytes", (int64_t)r->arena_bytes);
    cJSON *keyframes = cJSON_AddArrayToObject(root, "keyframes");
    for (uint32_t i = 0; i < s->keyframe_count; i++) {
        const keyframe *k = &s->keyframes[i];
        cJSON *item = cJSON_CreateObject();
        json_add_integer(item, "frame", k->frame);
        json_add_integer(item, "gaussians", k->report.gaussians);
        json_add_integer(item, "added", k->report.added);
        json_add_integer(item, "removed", k->report.removed);
        json_add_integer(item, "crowded", k->report.crowded);
        json_add_integer(item, "points", k->report.points);
        json_add_integer(item, "shown", k->report.shown);
        json_add_integer(item, "moved", k->report.moved);
        frame_figures_add(item, &k->report);
        cJSON_AddNumberToObject(item, "ms", k->milliseconds);
        json_add_hash(item, "hash", k->hash);
        cJSON_AddItemToArray(keyframes, item);
    }
    frame_decisions_add(root, &s->decisions);
    cJSON *held = cJSON_AddArrayToObject(root, "held_back");
    for (uint32_t i = 0; i < s->held_count; i++) {
        const held_back *h = &s->held[i];
        cJSON *item = cJSON_CreateObject();
        json_add_integer(item, "frame", h->frame);
        if (h->has_live) {
            add_decibels(item, "live_psnr", h->live_psnr);
            add_decibels(item, "live_psnr_all", h->live_psnr_all);
        }
        add_decibels(item, "final_psnr", h->final_psnr);
        add_decibels(item, "final_psnr_all", h->final_psnr_all);
        cJSON_AddItemToArray(held, item);
    }
    means m = means_of(s);
    add_decibels(root, "live_psnr", m.live);
    add_decibels(root, "live_psnr_all", m.live_all);
    add_decibels(root, "final_psnr", m.final);
    add_decibels(root, "final_psnr_all", m.final_all);
    hash_report_add_stages(root, r);
    json_add_hash(root, "hash", hash);
    expectation_add(root, e, difference);
    json_print(root);
}

static void print_text(const stream_run *s, uint64_t hash)
{
    const reconstruction *r = &s->r;
    printf("%s: %" PRIu32 " keyframes, one in %" PRIu32 " frames at least, %" PRIu32 " live, at most %" PRIu32
           " Gaussians, head %s, arena %zu bytes\n",
           s->path, s->keyframe_count, s->every, r->config.views, r->config.gaussians, r->head.name, r->arena_bytes);
    printf("%s%8s %10s %8s %8s %8s %8s %8s%s\n", style_begin(stdout, STYLE_HEADING), "keyframe", "Gaussians", "added",
           "removed", "crowded", "shown, %", "ms", style_end(stdout));
    for (uint32_t i = 0; i < s->keyframe_count; i++) {
        const keyframe *k = &s->keyframes[i];
        printf("%8" PRIu32 " %10" PRIu32 " %8" PRIu32 " %8" PRIu32 " %8" PRIu32 " %8.1f %8.1f\n", k->frame,
               k->report.gaussians, k->report.added, k->report.removed, k->report.crowded,
               100.0 * k->report.shown / k->report.points, k->milliseconds);
    }
    frame_decisions_print(&s->decisions);
    means m = means_of(s);
    if (m.final_count > 0) {
        printf("held-back frames, mean PSNR where they have a depth | everywhere:");
        if (m.live_count > 0) {
            printf(" after the next keyframe %.2f | %.2f dB (%" PRIu32 "),", m.live, m.live_all, m.live_count);
        }
        printf(" in the end %.2f | %.2f dB (%" PRIu32 ")\n", m.final, m.final_all, m.final_count);
    }
    if (s->options->output != NULL) {
        printf("%s: %" PRIu32 " Gaussians\n", s->options->output, r->scene.count);
    }
    hash_report_print(r, hash);
}

/* Finds the first difference, as text; "" when there is none. A stage's hashes are chained over all keyframes, so the
 * first stage that differs belongs to the first keyframe that differs, or to a later one. */
static void find_difference(const expectation *e, const stream_run *s, uint64_t hash, char *text, size_t text_bytes)
{
    (void)expectation_missed(e, &s->r, hash, text, text_bytes);
    for (uint32_t i = 0; i < e->keyframe_count && i < s->keyframe_count; i++) {
        if (e->keyframes[i] != s->keyframes[i].hash) {
            size_t length = strlen(text);
            snprintf(text + length, text_bytes - length, "%skeyframe %" PRIu32, length > 0 ? ", " : "",
                     s->keyframes[i].frame);
            return;
        }
    }
}

int replay_stream(const replay_stream_options *options, const t3r_recording *recording, const char *path,
                  const reconstruction_options *settings, const expectation *e)
{
    stream_run s = {
        .options = options,
        .recording = recording,
        .path = path,
        .every = options->every > 0 ? options->every : REPLAY_STREAM_EVERY,
        .views_hash = T3R_HASH_START,
    };
    uint32_t frames = t3r_recording_frame_count(recording);
    reconstruction_options first = *settings; /* the frames that a budget in percent refers to */
    first.context_count = frames > s.every ? 2 : 1;
    first.context[0] = 0;
    first.context[1] = s.every;
    if (options->images != NULL && mkdir(options->images, 0777) != 0 && errno != EEXIST) {
        return cli_error(CLI_BAD_INPUT, "%s: %s", options->images, strerror(errno));
    }
    int code = reconstruction_stream(&s.r, recording, path, &first,
                                     options->at_hand > 0 ? options->at_hand : REPLAY_STREAM_AT_HAND);
    if (code != CLI_OK) {
        return code;
    }
    code = open_pictures(&s);
    if (code == CLI_OK) {
        code = run(&s);
    }
    if (code == CLI_OK && options->output != NULL) {
        code = write_map(&s);
    }
    if (code == CLI_OK) {
        uint64_t hash = t3r_hash_u64(reconstruction_hash(&s.r), s.views_hash);
        char difference[128];
        find_difference(e, &s, hash, difference, sizeof difference);
        if (options->json) {
            print_json(&s, hash, e, difference);
        } else {
            print_text(&s, hash);
        }
        code = expectation_verdict(e, path, hash, difference, options->json);
    }
    frame_decisions_close(&s.decisions);
    free(s.held);
    free(s.keyframes);
    free(s.depth);
    free(s.mask);
    free(s.drawn);
    free(s.target);
    reconstruction_close(&s.r);
    return code;
}
