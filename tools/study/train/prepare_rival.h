/* SPDX-License-Identifier: Apache-2.0 */
/* Chooses the points that a rival keeps, by the code of `trim3r eval`'s +head methods. */
#ifndef TRIM3R_TRAIN_PREPARE_RIVAL_H
#define TRIM3R_TRAIN_PREPARE_RIVAL_H

#include <stdint.h>

#include "study/rivals/scores/kinds.h"
#include "trim3r.h"

/* Makes every point's importance for a t3r_request: 65535 at the points of the `count` Gaussians that `kind` ranks
 * highest, 0 elsewhere. `scene` is the unpruned one in `rt`, made of the `views` views of the cameras.
 * planes[views]: each of the working size. T3R_ERR_ARENA if out of memory, T3R_ERR_STATE if the scene does not match
 * the masks in `rt`. */
t3r_status prepare_rival(const t3r_runtime *rt, const t3r_scene *scene, const t3r_camera *cameras, uint32_t views,
                         method_kind kind, uint32_t count, uint32_t seed, uint16_t *const planes[]);

#endif
