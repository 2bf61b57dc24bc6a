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
#include "core/hash.h"
#include "pictures/metrics.h"
#include "pictures/picture.h"
#include "reconstruction/developed_frame.h"
#include "reconstruction/replay/stream_run.h"

#define TEXT_BYTES 4096

/* ---- held-back frames ------------------------------------------------------------------------------------------ */

static int write_picture(const stream_run *s, const char *what, uint32_t frame, uint32_t channels, uint8_t *samples)
{
    char path[TEXT_BYTES], error[TEXT_BYTES + 256] = "";
    int length = snprintf(path, sizeof path, "%s/%s_%05" PRIu32 ".png", s->options->images, what, frame);
    if (length < 0 || (size_t)length >= sizeof path) {
        return cli_error(CLI_BAD_INPUT, "%s: the path is too long", s->options->images);
    }
    picture p = {.width = s->view.width, .height = s->view.height, .channels = channels, .bits = 8, .samples = samples};
    return picture_write_png(path, &p, error, sizeof error) == 0 ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s", error);
}

/* Scores the view over the pixels that the recorded picture reaches, and over those of them that a keyframe saw. */
static int score_all(stream_run *s, const t3r_capture_frame *captured, uint32_t frame, held_scores *scores)
{
    const drawn_frame *d = &s->view;
    const size_t pixels = (size_t)d->width * d->height;
    uint8_t *shown = malloc(pixels), *seen = malloc(pixels);
    int code = shown != NULL && seen != NULL ? CLI_OK : cli_error(CLI_BAD_INPUT, "out of memory");
    if (code == CLI_OK) {
        code = developed_shown(captured, s->path, frame, d->width, d->height, shown);
    }
    if (code == CLI_OK) {
        scores->psnr_all = metric_psnr(d->target, d->drawn, shown, d->width, d->height);
        code = stream_seen_mask(&s->seen, captured, &d->camera, d->depth, seen);
    }
    uint32_t of_all = 0, of_seen = 0;
    for (size_t i = 0; i < pixels && code == CLI_OK; i++) {
        of_all += shown[i] != 0;
        of_seen += seen[i] != 0;
    }
    if (code == CLI_OK) {
        scores->psnr_seen = metric_psnr(d->target, d->drawn, seen, d->width, d->height);
        scores->seen = (double)of_seen / of_all;
    }
    free(shown);
    free(seen);
    return code;
}

/* Draws the frame's view from the current map and compares. */
static int draw_held(stream_run *s, uint32_t frame, const char *when, held_scores *scores)
{
    const drawn_frame *d = &s->view;
    t3r_capture_frame captured;
    int code = recorded_frame_read(s->recording, s->path, frame, &captured);
    if (code != CLI_OK) {
        return code;
    }
    const t3r_status status = drawn_frame_draw(&s->view, &s->map.r, &captured, DRAWN_WITH_DEPTH);
    if (status == T3R_ERR_CAMERA) { /* out of the map's range: nothing to compare */
        *scores = (held_scores){NAN, NAN, NAN, NAN};
        return CLI_OK;
    }
    if (status != T3R_OK) {
        return cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 ": %s", s->path, frame, t3r_error_text(status));
    }
    scores->psnr = drawn_frame_psnr(d);
    s->is.views_hash = t3r_hash_bytes(s->is.views_hash, d->drawn, (size_t)d->width * d->height * 3);
    if (s->options->images != NULL) {
        code = write_picture(s, when, frame, 3, d->drawn);
        if (code == CLI_OK) {
            code = write_picture(s, "frame", frame, 3, d->target);
        }
        if (code == CLI_OK) {
            code = write_picture(s, "mask", frame, 1, d->mask);
        }
    }
    return code == CLI_OK ? score_all(s, &captured, frame, scores) : code; /* it reads other frames */
}

/* Draws the frames between the keyframe just taken and the previous one. */
static int draw_live(stream_run *s)
{
    int code = CLI_OK;
    for (; code == CLI_OK && s->is.drawn < s->is.held_count; s->is.drawn++) {
        held_back *h = &s->held[s->is.drawn];
        code = draw_held(s, h->frame, "live", &h->live);
    }
    return code;
}

static int draw_final(stream_run *s)
{
    int code = CLI_OK;
    for (uint32_t i = 0; i < s->is.held_count && code == CLI_OK; i++) {
        held_back *h = &s->held[i];
        code = draw_held(s, h->frame, "final", &h->final);
    }
    return code;
}

/* ---- the run ----------------------------------------------------------------------------------------------------- */

static bool is_past(const stream_run *s, const t3r_capture_frame *frame)
{
    const replay_stream_options *o = s->options;
    const int64_t first_ns = t3r_recording_frame_message(s->recording, 0, T3R_USE_COLOUR).stamp_ns;
    return o->has_until && (o->until_frame < UINT32_MAX ? frame->index > o->until_frame
                                                        : (uint64_t)(frame->stamp_ns - first_ns) > o->until_ns);
}

/* Reads the next frame, or what it lacks into the next row. */
static bool read_frame(stream_run *s, t3r_capture_frame *frame)
{
    char lost[512] = "", error[512] = "";
    const int status =
        t3r_recording_frame_readable(s->recording, s->is.next, frame, lost, sizeof lost, error, sizeof error);
    live_row *row = &s->rows[s->is.row_count];
    *row = (live_row){.frame = s->is.next, .stamp_ns = frame->stamp_ns, .psnr_before = NAN};
    row->loss = status != T3R_CAPTURE_FRAME ? LIVE_UNREADABLE
                : !frame->has_pose          ? LIVE_NO_POSE
                : !frame->has_intrinsics    ? LIVE_NO_INTRINSICS
                                            : LIVE_WHOLE;
    return row->loss == LIVE_WHOLE;
}

/* Reports the row of a frame that was offered, or could not be. Only a keyframe changes the map. */
static int end_row(stream_run *s)
{
    const live_row *row = &s->rows[s->is.row_count++];
    int code = live_output_row(&s->output, &s->map, row);
    if (code == CLI_OK && live_row_is_taken(row)) {
        code = stream_seen_add(&s->seen, row->frame);
    }
    if (code == CLI_OK && live_row_is_taken(row)) {
        code = draw_live(s);
    }
    return code == CLI_OK ? stream_save(s, row) : code;
}

static int run(stream_run *s)
{
    const uint32_t frames = t3r_recording_frame_count(s->recording);
    int code = CLI_OK;
    while (code == CLI_OK && s->is.next < frames) {
        t3r_capture_frame frame = {0};
        const bool whole = read_frame(s, &frame);
        if (whole && is_past(s, &frame)) {
            break;
        }
        s->is.next++;
        if (!whole || live_map_frame(&s->map, &frame, &s->rows[s->is.row_count])) {
            code = end_row(s);
        } else {
            s->held[s->is.held_count++] = (held_back){.frame = frame.index};
        }
    }
    if (code == CLI_OK && s->options->rounds > 0) {
        code = stream_rounds(s);
    }
    if (code == CLI_OK) {
        code = stream_save(s, NULL); /* before views of the whole map: they count in the hashes */
    }
    return code == CLI_OK ? draw_final(s) : code;
}

/* Finds the first difference, as text; "" when there is none. A stage's hashes are chained over all keyframes, so the
 * first stage that differs belongs to the first keyframe that differs, or to a later one. */
static void find_difference(const expectation *e, const stream_run *s, uint64_t hash, char *text, size_t text_bytes)
{
    (void)expectation_missed(e, &s->map.r, hash, text, text_bytes);
    for (uint32_t i = 0, keyframe = 0; i < s->is.row_count && keyframe < e->keyframe_count; i++) {
        const live_row *row = &s->rows[i];
        if (live_row_is_taken(row) && e->keyframes[keyframe++] != row->hash) {
            const size_t length = strlen(text);
            snprintf(text + length, text_bytes - length, "%skeyframe %" PRIu32, length > 0 ? ", " : "", row->frame);
            return;
        }
    }
}

static bool prints_text(const stream_run *s)
{
    return !s->options->json && !live_options_print_lines(&s->options->live);
}

static int report(const stream_run *s, const expectation *e)
{
    const uint64_t hash = t3r_hash_u64(reconstruction_hash(&s->map.r), s->is.views_hash);
    char difference[128];
    find_difference(e, s, hash, difference, sizeof difference);
    if (s->options->json) {
        stream_print_json(s, hash, e, difference);
    } else if (prints_text(s)) {
        stream_print(s, hash);
    }
    return expectation_verdict(e, s->path, hash, difference, !prints_text(s));
}

static int open_run(stream_run *s)
{
    const t3r_config *config = &s->map.r.config;
    const size_t frames = t3r_recording_frame_count(s->recording);
    const char *images = s->options->images;
    s->rows = calloc(frames + 1, sizeof *s->rows);
    s->held = calloc(frames + 1, sizeof *s->held);
    if (s->rows == NULL || s->held == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    if (images != NULL && mkdir(images, 0777) != 0 && errno != EEXIST) {
        return cli_error(CLI_BAD_INPUT, "%s: %s", images, strerror(errno));
    }
    if (prints_text(s)) {
        stream_print_begin(s);
    }
    int code = drawn_frame_open(&s->view, config->width, config->height);
    if (code == CLI_OK) {
        code = stream_seen_open(&s->seen, s->recording, s->path, config->width, config->height);
    }
    if (code == CLI_OK) {
        code = stream_open(s);
    }
    for (uint32_t i = 0; i < s->is.row_count && code == CLI_OK; i++) { /* of a stream that goes on */
        code = live_row_is_taken(&s->rows[i]) ? stream_seen_add(&s->seen, s->rows[i].frame) : CLI_OK;
    }
    return code;
}

int replay_stream(const replay_stream_options *options, const t3r_recording *recording, const char *path,
                  const reconstruction_options *settings, const expectation *e)
{
    stream_run s = {.options = options, .recording = recording, .path = path, .is = {.views_hash = T3R_HASH_START}};
    reconstruction_options hashed = *settings;
    hashed.hash = !options->no_hash;
    int code = live_map_open_recorded(&s.map, recording, path, &hashed, &options->live);
    if (code != CLI_OK) {
        return code;
    }
    code = open_run(&s);
    if (code == CLI_OK) {
        code = run(&s);
    }
    if (code == CLI_OK) {
        code = report(&s, e);
    }
    live_output_close(&s.output);
    drawn_frame_close(&s.view);
    stream_seen_close(&s.seen);
    free(s.held);
    free(s.rows);
    live_map_close(&s.map);
    return code;
}
