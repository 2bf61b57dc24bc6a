/* Cameras and depth units in doubles, of recordings and of what becomes one, to the runtime's fixed point: within its
 * ranges (reader_limits.h) after rounding, or refused. Whoever reads and whoever writes asks here, so that what one
 * takes the other can use. */
#ifndef T3R_PLATFORM_FIXED_CAMERA_H
#define T3R_PLATFORM_FIXED_CAMERA_H

#include <stdbool.h>
#include <stdint.h>

#include "recording/recording.h"

/* Of a double's bits; false for NaN and for what lies outside. */
bool t3r_fixed_focal(uint64_t f64, int32_t *q16);
bool t3r_fixed_centre(uint64_t f64, int32_t *q16);
bool t3r_fixed_position(uint64_t f64, int64_t *q32);
bool t3r_fixed_rotation(uint64_t f64, int32_t *q30);
/* Coefficient `index` in the order of t3r_distortion. */
bool t3r_fixed_coefficient(uint64_t f64, t3r_distortion distortion, uint32_t index, int32_t *q24);
bool t3r_fixed_depth_unit(double unit, uint64_t *q40);

/* The whole camera as a reader of the recording will see it. NULL, or what is wrong: "field: what is supported". */
const char *t3r_fixed_camera(const t3r_recorded_camera *in, t3r_camera *out);

#endif
