/* SPDX-License-Identifier: Apache-2.0 */
/* The pixels of a frame held back whose surface a keyframe saw: a map can show no others. */
#ifndef TRIM3R_TOOLS_STREAM_SEEN_H
#define TRIM3R_TOOLS_STREAM_SEEN_H

#include "geometry/seen.h"
#include "reconstruction/context/nearest_views.h"
#include "recording/recording.h"

/* Keyframes that are looked at for a frame: the nearest ones, which saw most of it. */
#define STREAM_SEEN_NEAREST 8u

/* A keyframe's own depth. */
typedef struct seen_keyframe {
    uint32_t frame; /* UINT32_MAX: none */
    t3r_camera camera;
    uint16_t *depth; /* width x height steps */
    double unit;     /* of a step, in world units */
} seen_keyframe;

typedef struct stream_seen {
    const t3r_recording *recording;
    const char *path; /* of the recording, in messages */
    uint32_t width, height;
    view_place *places;                      /* of the recording's frames; usable: keyframes */
    seen_keyframe kept[STREAM_SEEN_NEAREST]; /* those that were looked at last */
    uint8_t *rgb;                            /* a developed picture that nobody needs */
} stream_seen;

/* These return an exit status of cli.h. stream_seen_close() is due in any case. */
int stream_seen_open(stream_seen *s, const t3r_recording *recording, const char *path, uint32_t width, uint32_t height);
void stream_seen_close(stream_seen *s);
/* Adds a keyframe. */
int stream_seen_add(stream_seen *s, uint32_t frame);
/* Sets mask (width x height) to 255 where one of the keyframes so far saw the surface of a frame, else to 0. camera and
 * depth are those of the developed frame. Reads other frames of the recording. */
int stream_seen_mask(stream_seen *s, const t3r_capture_frame *frame, const t3r_camera *camera, const uint16_t *depth,
                     uint8_t *mask);

#endif
