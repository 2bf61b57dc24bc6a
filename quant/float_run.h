/* SPDX-License-Identifier: Apache-2.0 */
/* Runs a float head over one view: for calibration, and for comparison with the quantized head. */
#ifndef T3R_QUANT_FLOAT_RUN_H
#define T3R_QUANT_FLOAT_RUN_H

#include "float_head.h"

typedef struct float_plane {
    uint32_t width, height, channels;
    float *values; /* [height][width][channels]; for a point layer 0 except at retained pixels */
} float_plane;

/* planes[0] holds the features, planes[n] the output of layer n. */
typedef struct float_planes {
    float_plane planes[T3R_MAX_LAYERS + 1];
} float_planes;

/* Runs a head. features: int8 [height][width][T3R_FEATURES]; retained: not 0 for a retained pixel. Returns 0, after
 * which float_planes_free() is due; or -1 without memory. */
int float_run(float_planes *out, const float_head *head, const int8_t *features, const uint8_t *retained,
              uint32_t width, uint32_t height);
void float_planes_free(float_planes *planes);

#endif
