/* SPDX-License-Identifier: Apache-2.0 */
/* Some of the rows of a scene. */
#ifndef TRIM3R_TOOLS_CHOSEN_ROWS_H
#define TRIM3R_TOOLS_CHOSEN_ROWS_H

#include "scene/scene_extent.h"
#include "scene/scene_rows.h"

typedef struct chosen_rows {
    scene_rows rows; /* those chosen; they need `all`, and this to stay where it is */
    const scene_rows *all;
    uint32_t *index; /* heap; chosen_rows_free() */
    uint32_t left_out;
} chosen_rows;

/* Chooses the rows that can be read. Returns 0; or -1 with the reason in error[], if there are none, too.
 * chosen_rows_free() is due in any case. */
int chosen_rows_valid(const scene_rows *all, chosen_rows *out, char *error, size_t error_bytes);
/* Chooses the rows within the reach of their extent, likewise. */
int chosen_rows_near(const scene_rows *all, const scene_extent *extent, chosen_rows *out, char *error,
                     size_t error_bytes);
/* Chooses the rows that a crop keeps, likewise. */
int chosen_rows_cropped(const scene_rows *all, const scene_crop *crop, chosen_rows *out, char *error,
                        size_t error_bytes);
void chosen_rows_free(chosen_rows *chosen);

#endif
