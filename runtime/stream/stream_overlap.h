/* SPDX-License-Identifier: Apache-2.0 */
/* How much a camera would see of what the newest keyframe saw. */
#ifndef T3R_STREAM_OVERLAP_H
#define T3R_STREAM_OVERLAP_H

#include <stdint.h>

#include "trim3r.h"

/* The checked camera, of a picture of width x height; a keyframe has been taken. */
t3r_status t3r_overlap_with_newest(const t3r_runtime *rt, const t3r_camera *camera, uint32_t width, uint32_t height,
                                   uint32_t *overlap_q8);

#endif
