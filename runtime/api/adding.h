/* SPDX-License-Identifier: Apache-2.0 */
/* What a context view takes, whether it comes whole or in strips. */
#ifndef T3R_ADDING_H
#define T3R_ADDING_H

#include <stdbool.h>

#include "trim3r.h"

/* Whether the state allows another view. */
bool t3r_takes_view(const t3r_runtime *rt);

/* The slot of the next view: where there is no room for another, that of the oldest. */
uint32_t t3r_slot_of_next(const t3r_runtime *rt);

/* Before a plane of it is written: what the image stage works over is gone, and so is a view that came in part. */
void t3r_begin_view(t3r_runtime *rt);

/* Its planes are there. T3R_ERR_NO_DEPTH: without a measurement, which adds no view. */
t3r_status t3r_end_view(t3r_runtime *rt, uint32_t slot, const t3r_camera *undistorted, uint64_t depth_unit_q40);

#endif
