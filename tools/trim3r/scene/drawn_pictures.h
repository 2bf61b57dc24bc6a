/* SPDX-License-Identifier: Apache-2.0 */
/* How well a scene draws the pictures that it was made of, and others of the recording. */
#ifndef TRIM3R_TOOLS_DRAWN_PICTURES_H
#define TRIM3R_TOOLS_DRAWN_PICTURES_H

#include <stdbool.h>
#include <stdint.h>

#include "reconstruction/reconstruction.h"

#define DRAWN_OTHERS 16u /* most frames beside the context that are drawn, evenly spread */
#define DRAWN_MOST (T3R_MAX_VIEWS + DRAWN_OTHERS)

typedef struct drawn_picture {
    uint32_t frame;
    bool used;            /* a context frame */
    double psnr;          /* dB, of the whole picture */
    double empty;         /* share of its pixels that the scene leaves empty */
    bool blurred;         /* against the other pictures */
    const char *no_depth; /* why stereo matched it with no other; NULL if it did, or by sensor */
} drawn_picture;

/* Draws the context frames of `r` in order, then others with a pose, and compares. Frames that cannot be read are left
 * out. *count: at most DRAWN_MOST. No hash of `r` changes. Returns an exit status of cli.h. */
int drawn_pictures(const t3r_recording *recording, const char *path, reconstruction *r,
                   const reconstruction_account *account, drawn_picture pictures[DRAWN_MOST], uint32_t *count);

#endif
