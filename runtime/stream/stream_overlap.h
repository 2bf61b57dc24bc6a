/* SPDX-License-Identifier: Apache-2.0 */
/* The share of the newest keyframe's points that a camera would see. */
#ifndef T3R_STREAM_OVERLAP_H
#define T3R_STREAM_OVERLAP_H

#include <stdint.h>

#include "trim3r.h"

/* Computes t3r_stream_overlap() for a checked camera with a picture of width x height; there is a keyframe. */
t3r_status t3r_overlap_with_newest(const t3r_runtime *rt, const t3r_camera *camera, uint32_t width, uint32_t height,
                                   uint32_t *overlap_q8);

#endif
