/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/replay/stream_seen.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "reconstruction/developed_frame.h"

static double unit_of(const t3r_frame *frame)
{
    return ldexp((double)frame->depth_unit_q40, -40);
}

int stream_seen_open(stream_seen *s, const t3r_recording *recording, const char *path, uint32_t width, uint32_t height)
{
    const size_t pixels = (size_t)width * height;
    *s = (stream_seen){.recording = recording, .path = path, .width = width, .height = height};
    s->places = calloc(t3r_recording_frame_count(recording) + 1, sizeof *s->places);
    s->rgb = malloc(3 * pixels);
    bool whole = s->places != NULL && s->rgb != NULL;
    for (uint32_t i = 0; i < STREAM_SEEN_NEAREST; i++) {
        s->kept[i].frame = UINT32_MAX;
        s->kept[i].depth = malloc(pixels * sizeof *s->kept[i].depth);
        whole = whole && s->kept[i].depth != NULL;
    }
    return whole ? CLI_OK : cli_error(CLI_BAD_INPUT, "out of memory");
}

void stream_seen_close(stream_seen *s)
{
    for (uint32_t i = 0; i < STREAM_SEEN_NEAREST; i++) {
        free(s->kept[i].depth);
    }
    free(s->places);
    free(s->rgb);
    *s = (stream_seen){0};
}

int stream_seen_add(stream_seen *s, uint32_t frame)
{
    t3r_capture_frame captured;
    const int code = recorded_frame_read(s->recording, s->path, frame, &captured);
    if (code == CLI_OK) {
        s->places[frame] = view_place_of(&captured.camera);
        s->places[frame].usable = captured.frame.depth != NULL;
    }
    return code;
}

/* Moves the keyframes that are wanted and kept to their place in the order of `wanted`, and develops the others. */
static int look_at(stream_seen *s, const uint32_t *wanted, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = i;
        while (at < STREAM_SEEN_NEAREST && s->kept[at].frame != wanted[i]) {
            at++;
        }
        const bool is_kept = at < STREAM_SEEN_NEAREST;
        seen_keyframe *to = &s->kept[i], *from = &s->kept[is_kept ? at : STREAM_SEEN_NEAREST - 1];
        const seen_keyframe other = *to;
        *to = *from;
        *from = other;
        if (is_kept) {
            continue;
        }
        t3r_capture_frame captured;
        to->frame = UINT32_MAX;
        int code = recorded_frame_read(s->recording, s->path, wanted[i], &captured);
        if (code == CLI_OK) {
            code =
                developed_capture(&captured, s->path, wanted[i], s->width, s->height, s->rgb, to->depth, &to->camera);
        }
        if (code != CLI_OK) {
            return code;
        }
        to->frame = wanted[i];
        to->unit = unit_of(&captured.frame);
    }
    return CLI_OK;
}

int stream_seen_mask(stream_seen *s, const t3r_capture_frame *frame, const t3r_camera *camera, const uint16_t *depth,
                     uint8_t *mask)
{
    const size_t pixels = (size_t)s->width * s->height;
    const double median = frame->frame.depth != NULL ? view_median_depth(&frame->frame) : 0;
    memset(mask, 0, pixels);
    if (!(median > 0)) {
        return CLI_OK;
    }
    uint32_t nearest[STREAM_SEEN_NEAREST];
    s->places[frame->index] = view_place_of(&frame->camera);
    s->places[frame->index].usable = false; /* it is no keyframe */
    const uint32_t count = nearest_views(s->places, t3r_recording_frame_count(s->recording), frame->index, median,
                                         STREAM_SEEN_NEAREST, nearest, 0);
    const int code = look_at(s, nearest, count);
    if (code != CLI_OK) {
        return code;
    }
    seen_view views[STREAM_SEEN_NEAREST];
    for (uint32_t i = 0; i < count; i++) {
        views[i] = (seen_view){&s->kept[i].camera, s->kept[i].depth, s->kept[i].unit};
    }
    const seen_view target = {camera, depth, unit_of(&frame->frame)};
    seen_mask(mask, s->width, s->height, &target, views, count);
    return CLI_OK;
}
