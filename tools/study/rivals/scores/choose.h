/* SPDX-License-Identifier: Apache-2.0 */
/* Selects the Gaussians of an unpruned scene to keep, and finds the pixels of its views that they came from. */
#ifndef TRIM3R_TOOLS_RIVALS_CHOOSE_H
#define TRIM3R_TOOLS_RIVALS_CHOOSE_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

/* Writes the indices of the `count` highest scores in rising order to kept[count]; ties go to the lower index. From
 * index `surfaces` on, Gaussians are a rim or a backdrop. They have no place among the scores: all are kept if there is
 * as much room for them as in trim3r's own scenes, else none. Returns false if out of memory. */
bool rival_choose(const double *score, uint32_t surfaces, uint32_t of, uint32_t count, uint32_t *kept);

/* Makes the importances of the allocation `given`: 65535 at the pixels whose points became the Gaussians kept[count]
 * (ascending indices into `scene`), 0 elsewhere; with kept == NULL, 65535 at every retained pixel. `scene` is the
 * scene in `rt`, which keeps its analysis; its Gaussians are ordered by view, row and column. planes[views]: each of
 * the working size, rows without gaps. False if the scene does not match the masks. */
bool rival_planes(const t3r_runtime *rt, const t3r_scene *scene, uint32_t views, const uint32_t *kept, uint32_t count,
                  uint16_t *const planes[]);

#endif
