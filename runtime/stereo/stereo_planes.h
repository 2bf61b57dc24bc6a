/* One side of a rectified pair in the work memory of stereo: the parts of T3R_STEREO_SIDE_BYTES_(). */
#ifndef T3R_STEREO_PLANES_H
#define T3R_STEREO_PLANES_H

#include "core/cut.h"

typedef struct t3r_stereo_side {
    uint8_t *luma, *confidence;
    uint16_t *disparity;
} t3r_stereo_side;

static inline t3r_stereo_side t3r_take_side(t3r_cut *cut, size_t pixels)
{
    t3r_stereo_side side;
    side.luma = t3r_take(cut, pixels);
    side.confidence = t3r_take(cut, pixels);
    side.disparity = t3r_take(cut, pixels * sizeof *side.disparity);
    return side;
}

#endif
