/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/chosen_rows.h"

#include <inttypes.h>
#include <stdlib.h>

#include "host/reason.h"

static int read_chosen(void *user, uint32_t index, scene_row *row, char *error, size_t error_bytes)
{
    const chosen_rows *chosen = user;
    return chosen->all->read(chosen->all->user, chosen->index[index], row, error, error_bytes);
}

/* Chooses rows that can be read; with an extent, those within its reach alone. */
static int choose(const scene_rows *all, const scene_extent *extent, chosen_rows *out, char *error, size_t error_bytes)
{
    scene_row row;
    *out = (chosen_rows){.rows = *all, .all = all, .index = malloc(all->count * sizeof *out->index)};
    if (out->index == NULL) {
        return t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " Gaussians", all->count);
    }
    out->rows.count = 0;
    out->rows.read = read_chosen;
    out->rows.user = out;
    for (uint32_t i = 0; i < all->count; i++) {
        if (scene_rows_read(all, i, &row, error, error_bytes) == 0 &&
            (extent == NULL || scene_extent_holds(extent, row.position))) {
            out->index[out->rows.count++] = i;
        }
    }
    out->left_out = all->count - out->rows.count;
    return out->rows.count > 0 ? 0 : t3r_reason(error, error_bytes, "none of its Gaussians is valid");
}

int chosen_rows_valid(const scene_rows *all, chosen_rows *out, char *error, size_t error_bytes)
{
    return choose(all, NULL, out, error, error_bytes);
}

int chosen_rows_near(const scene_rows *all, const scene_extent *extent, chosen_rows *out, char *error,
                     size_t error_bytes)
{
    return choose(all, extent, out, error, error_bytes);
}

void chosen_rows_free(chosen_rows *chosen)
{
    free(chosen->index);
}
