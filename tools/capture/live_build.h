/* SPDX-License-Identifier: Apache-2.0 */
/* Builds Gaussians from frames as they arrive. All memory is allocated once, the newest frame is read where its driver
 * put it, and the result equals `trim3r build` on a recording of the same frames, bit for bit. */
#ifndef TRIM3R_TOOLS_LIVE_BUILD_H
#define TRIM3R_TOOLS_LIVE_BUILD_H

#include "reconstruction/reconstruction.h"
#include "trim3r_capture.h"

/* A context frame whose buffer had to go back to its driver. */
typedef struct live_frame {
    t3r_capture_frame frame; /* points into `bytes` */
    uint8_t *bytes;
} live_frame;

typedef struct live_build {
    reconstruction_options options;
    reconstruction r; /* result of a build: scene, hashes, valid points, seconds */
    live_frame kept[T3R_MAX_VIEWS];
    uint32_t kept_count, room; /* frames kept, and most frames kept: one less than views */
    size_t frame_bytes;        /* room for each frame */
    uint8_t *rgb;              /* output of counting */
    uint16_t *depth;
    uint32_t builds;
} live_build;

/* Opens a build of `views` context views of frames like this one, which must be complete. Returns CLI_OK, after which
 * live_build_close() is due; or an exit status after a message. */
int live_build_open(live_build *build, const reconstruction_options *options, uint32_t views,
                    const t3r_capture_frame *like);
void live_build_close(live_build *build);

/* Returns what a frame lacks for a context view; NULL: nothing. */
const char *live_build_lacks(const t3r_capture_frame *frame);
/* Keeps a copy as the next context view; when all places are taken, it replaces the oldest. */
int live_build_keep(live_build *build, const t3r_capture_frame *frame);
/* Builds from the kept frames and this one. */
int live_build_make(live_build *build, const t3r_capture_frame *newest);

#endif
