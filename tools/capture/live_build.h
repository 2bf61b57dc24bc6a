/* Gaussians of frames as they come in: all memory is asked for once, the newest frame is read where its driver put it,
 * and the result is that of `trim3r build` on a recording of the same frames, bit for bit. */
#ifndef TRIM3R_TOOLS_LIVE_BUILD_H
#define TRIM3R_TOOLS_LIVE_BUILD_H

#include "capture/capture.h"
#include "reconstruction/reconstruction.h"

/* A context frame that had to go back to its driver. */
typedef struct live_frame {
    t3r_capture_frame frame; /* points into `bytes` */
    uint8_t *bytes;
} live_frame;

typedef struct live_build {
    reconstruction_options options;
    reconstruction r; /* what a build made: scene, hashes, valid points, seconds */
    live_frame kept[T3R_MAX_VIEWS];
    uint32_t kept_count, room; /* frames that are and can be kept: one less than views */
    size_t frame_bytes;        /* room of each */
    uint8_t *rgb;              /* what counting writes */
    uint16_t *depth;
    uint32_t builds;
} live_build;

/* For `views` context views of frames such as this one, which lacks nothing. CLI_OK, and live_build_close() is due; or
 * an exit status after a message. */
int live_build_open(live_build *build, const reconstruction_options *options, uint32_t views,
                    const t3r_capture_frame *like);
void live_build_close(live_build *build);

/* What the frame lacks to be a context view; NULL: nothing. */
const char *live_build_lacks(const t3r_capture_frame *frame);
/* Keeps a copy as the next context view; a further one takes the place of the oldest. */
int live_build_keep(live_build *build, const t3r_capture_frame *frame);
/* Builds from the kept frames and this one. */
int live_build_make(live_build *build, const t3r_capture_frame *newest);

#endif
