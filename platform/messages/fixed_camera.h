/* SPDX-License-Identifier: Apache-2.0 */
/* Converts cameras and depth units from doubles to the runtime's fixed point. Values outside its ranges
 * (reader_limits.h) after rounding are refused. Readers and writers of recordings share these checks, so that what one
 * accepts the other can use. */
#ifndef T3R_PLATFORM_FIXED_CAMERA_H
#define T3R_PLATFORM_FIXED_CAMERA_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r_host.h"

/* Converts a double's bits; false for NaN and values out of range. */
bool t3r_fixed_focal(uint64_t f64, int32_t *q16);
bool t3r_fixed_centre(uint64_t f64, int32_t *q16);
bool t3r_fixed_position(uint64_t f64, int64_t *q32);
bool t3r_fixed_rotation(uint64_t f64, int32_t *q30);
/* Converts coefficient `index`, in the order of t3r_distortion. */
bool t3r_fixed_coefficient(uint64_t f64, t3r_distortion distortion, uint32_t index, int32_t *q24);
bool t3r_fixed_depth_unit(double unit, uint64_t *q40);

/* Converts the whole camera like a reader of the recording. Returns NULL, or what is wrong: "field: what is
 * supported", a whole sentence. */
const char *t3r_fixed_camera(const t3r_recorded_camera *in, t3r_camera *out);

/* Whether the principal point lies in a picture of width x height. If nothing states the size that intrinsics are for,
 * those of another size often fail this. */
bool t3r_fixed_centre_is_within(const t3r_camera *camera, uint32_t width, uint32_t height);

#endif
