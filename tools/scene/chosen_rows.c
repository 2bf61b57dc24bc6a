/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/chosen_rows.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "host/reason.h"

static int read_chosen(void *user, uint32_t index, scene_row *row, char *error, size_t error_bytes)
{
    const chosen_rows *chosen = user;
    return chosen->all->read(chosen->all->user, chosen->index[index], row, error, error_bytes);
}

/* Whether a row is chosen, by what `user` says. */
typedef bool choice(const void *user, const scene_row *row);

/* Chooses rows that can be read, if is_chosen() says so. Returns 0, or -1 with the reason in error[]. */
static int choose(const scene_rows *all, choice *is_chosen, const void *user, chosen_rows *out, char *error,
                  size_t error_bytes)
{
    scene_row row;
    *out = (chosen_rows){.rows = *all, .all = all, .index = malloc(all->count * sizeof *out->index)};
    if (out->index == NULL) {
        return t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " Gaussians", all->count);
    }
    out->rows.count = out->rows.backdrop = 0;
    out->rows.read = read_chosen;
    out->rows.user = out;
    for (uint32_t i = 0; i < all->count; i++) {
        if (scene_rows_read(all, i, &row, error, error_bytes) == 0 && is_chosen(user, &row)) {
            out->index[out->rows.count++] = i;
            out->rows.backdrop += i >= all->count - all->backdrop;
        }
    }
    out->left_out = all->count - out->rows.count;
    return out->rows.count > 0 ? 0 : t3r_reason(error, error_bytes, "none of its Gaussians is valid");
}

static bool choose_all(const void *user, const scene_row *row)
{
    (void)user;
    (void)row;
    return true;
}

int chosen_rows_valid(const scene_rows *all, chosen_rows *out, char *error, size_t error_bytes)
{
    return choose(all, choose_all, NULL, out, error, error_bytes);
}

static bool is_near(const void *user, const scene_row *row)
{
    return scene_extent_holds(user, row->position);
}

int chosen_rows_near(const scene_rows *all, const scene_extent *extent, chosen_rows *out, char *error,
                     size_t error_bytes)
{
    return choose(all, is_near, extent, out, error, error_bytes);
}

/* A crop of rows, and the way from their positions to those of the world. */
typedef struct cropping {
    const scene_crop *crop;
    scene_turn turn;
    double shift[3];
} cropping;

static bool is_kept(const void *user, const scene_row *row)
{
    const cropping *c = user;
    double place[3] = {row->position[0], row->position[1], row->position[2]}, none[4] = {1, 0, 0, 0};
    scene_turn_apply(&c->turn, place, none, 0, NULL);
    bool is_inside = scene_row_opacity(row) >= c->crop->opacity;
    for (int axis = 0; axis < 3; axis++) {
        const double x = place[axis] + c->shift[axis];
        is_inside = is_inside && x >= c->crop->low[axis] && x <= c->crop->high[axis];
    }
    return is_inside;
}

int chosen_rows_cropped(const scene_rows *all, const scene_crop *crop, chosen_rows *out, char *error,
                        size_t error_bytes)
{
    cropping way = {.crop = crop, .turn = scene_turn_between(all->axes, SCENE_AXES_AS_THEY_ARE, T3R_UP_UNKNOWN)};
    for (int axis = 0; axis < 3 && all->has_frame && all->local; axis++) {
        way.shift[axis] = ldexp((double)all->frame.origin_q32[axis], -32);
    }
    const int result = choose(all, is_kept, &way, out, error, error_bytes);
    return result != 0 && out->index != NULL && out->left_out == all->count
               ? t3r_reason(error, error_bytes,
                            "none of its Gaussians is kept by --crop and --min-opacity; trim3r info "
                            "prints where they are")
               : result;
}

void chosen_rows_free(chosen_rows *chosen)
{
    free(chosen->index);
}
