/* SPDX-License-Identifier: Apache-2.0 */
/* A frame beside the view that a scene gives of it. All memory is allocated once. */
#ifndef TRIM3R_TOOLS_DRAWN_FRAME_H
#define TRIM3R_TOOLS_DRAWN_FRAME_H

#include <stdint.h>

#include "reconstruction/reconstruction.h"
#include "trim3r_capture.h"

typedef struct drawn_frame {
    t3r_runtime *runtime; /* develops frames: an arena that holds a scene cannot take them; NULL = closed */
    void *arena;
    uint32_t width, height;
    uint8_t *target, *drawn; /* the frame and the view, 3 bytes a pixel */
    uint8_t *mask;           /* 255 = the pixel counts */
    uint16_t *depth, *alpha_q15;
    t3r_camera camera; /* of the frame, without distortion */
} drawn_frame;

/* Allocates for this size. Returns an exit status of cli.h; drawn_frame_close() is due in any case. */
int drawn_frame_open(drawn_frame *d, uint32_t width, uint32_t height);
void drawn_frame_close(drawn_frame *d);

/* Pixels count where the frame has a depth; with alpha also only where the scene's opacity is at least one half. */
typedef enum drawn_mask { DRAWN_WITH_DEPTH, DRAWN_WITH_ALPHA } drawn_mask;
/* Develops the frame and draws the scene from there. */
t3r_status drawn_frame_draw(drawn_frame *d, const reconstruction *r, const t3r_capture_frame *frame, drawn_mask mask);
/* Returns the PSNR in dB over the pixels that count; NaN = none does. */
double drawn_frame_psnr(const drawn_frame *d);

#endif
