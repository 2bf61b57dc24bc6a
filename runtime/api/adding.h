/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by whole context views and views in strips. */
#ifndef T3R_ADDING_H
#define T3R_ADDING_H

#include <stdbool.h>

#include "trim3r.h"

/* Whether the state allows another view. */
bool t3r_takes_view(const t3r_runtime *rt);

/* Returns the slot of the next view: the oldest view's when all are taken. */
uint32_t t3r_slot_of_next(const t3r_runtime *rt);

/* Call before writing a plane: discards what the image stage overwrites, and a view that came in part. */
void t3r_begin_view(t3r_runtime *rt);

/* Adds the view whose planes are complete. T3R_ERR_NO_DEPTH: without a measurement, which adds no view. */
t3r_status t3r_end_view(t3r_runtime *rt, uint32_t slot, const t3r_camera *undistorted, uint64_t depth_unit_q40);

#endif
