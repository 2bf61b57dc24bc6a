/* Runs a float head over one view: what calibration measures, and what the quantized head is compared with. */
#ifndef T3R_QUANT_FLOAT_RUN_H
#define T3R_QUANT_FLOAT_RUN_H

#include "float_head.h"

typedef struct float_plane {
    uint32_t width, height, channels;
    float *values; /* [height][width][channels]; of a point layer at retained pixels only, elsewhere 0 */
} float_plane;

/* planes[0] the features, planes[n] the output of layer n. */
typedef struct float_planes {
    float_plane planes[T3R_MAX_LAYERS + 1];
} float_planes;

/* features: int8 [height][width][T3R_FEATURES]; retained: 0 or not, a pixel. 0, and float_planes_free() is due; -1
 * without memory. */
int float_run(float_planes *out, const float_head *head, const int8_t *features, const uint8_t *retained,
              uint32_t width, uint32_t height);
void float_planes_free(float_planes *planes);

#endif
