/* SPDX-License-Identifier: Apache-2.0 */
/* The search of t3r_rebuild_least() over a part of each view's pixels. */
#ifndef T3R_LEAST_H
#define T3R_LEAST_H

#include "trim3r.h"

/* Does what t3r_rebuild_least() does, and compares only some pixels. counted: for each view a byte a pixel, 0 = left
 * out, or NULL for all pixels; NULL = all pixels of all views. */
t3r_status t3r_rebuild_least_counted(t3r_runtime *rt, const t3r_request *request, uint32_t least_psnr_q8,
                                     const t3r_target *picture, const uint8_t *const *counted, t3r_scene *scene,
                                     t3r_least *found);

#endif
