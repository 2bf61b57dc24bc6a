/* SPDX-License-Identifier: Apache-2.0 */
/* Troubles of a moving camera, put into the frames of a recording: `trim3r replay --stream` meets them in turn. */
#ifndef TRIM3R_TOOLS_TROUBLE_H
#define TRIM3R_TOOLS_TROUBLE_H

#include <stdbool.h>
#include <stdint.h>

#include "recording/recording.h"

/* A frame to be changed: its pixels are copies. World units are metres. */
typedef struct troubled_frame {
    t3r_recorded_frame recorded;
    uint8_t *rgb;          /* width x height x 3 */
    uint16_t *depth;       /* depth_width x depth_height steps; NULL = none */
    double depth_unit;     /* metres a step */
    uint32_t since, until; /* frames since the first troubled one; their number. since >= until: afterwards */
} troubled_frame;

typedef struct trouble {
    const char *name, *about;
    bool lasts;                      /* also changes the frames after the last troubled one */
    void (*apply)(troubled_frame *); /* NULL: the order of the frames changes */
} trouble;

/* Returns trouble number `index`, in a stable order; NULL past the last. */
const trouble *trouble_at(uint32_t index);

/* Returns the frame of the source that the troubled recording has at `index`, or UINT32_MAX past its end. `first` and
 * `count`: the troubled frames. */
uint32_t trouble_source(const trouble *what, uint32_t index, uint32_t frames, uint32_t first, uint32_t count);

/* Applies the trouble to frame `index` of the troubled recording. */
void trouble_apply(const trouble *what, troubled_frame *frame, uint32_t index, uint32_t first, uint32_t count);

#endif
