/* SPDX-License-Identifier: Apache-2.0 */
/* Views: their memory, and the lists of splats for each tile in depth order. */
#include <stdlib.h>
#include <string.h>

#include "study/rivals/splats/splat_view.h"

bool splat_view_open(splat_view *view, const splat_camera *camera, uint32_t count)
{
    *view = (splat_view){.camera = *camera, .alpha_least = SPLAT_ALPHA_LEAST, .count = count};
    view->across = (camera->width + SPLAT_TILE - 1) / SPLAT_TILE;
    view->down = (camera->height + SPLAT_TILE - 1) / SPLAT_TILE;
    view->splats = malloc(((size_t)count + 1) * sizeof *view->splats);
    view->order = malloc(((size_t)count + 1) * 2 * sizeof *view->order);
    view->first = malloc(((size_t)view->across * view->down + 2) * sizeof *view->first);
    return view->splats != NULL && view->order != NULL && view->first != NULL;
}

void splat_view_close(splat_view *view)
{
    free(view->splats);
    free(view->order);
    free(view->first);
    free(view->list);
    *view = (splat_view){0};
}

bool splat_view_project(splat_view *view, const splat_model *model)
{
    for (uint32_t i = 0; i < view->count; i++) {
        view->splats[i] =
            splat_project(&view->camera, &model->parameters[(size_t)i * SPLAT_PARAMETERS], view->alpha_least);
    }
    return splat_view_bin(view);
}

/* Sorts by depth, then index: three stable passes of 11 bits cover a key's 31 bits. Returns the number of splats
 * drawn; *sorted is the half of `order` that holds them. */
static uint32_t sort(const splat_view *view, uint32_t **sorted)
{
    enum { BITS = 11, BUCKETS = 1 << BITS };
    uint32_t *from = view->order, *to = view->order + view->count, drawn = 0;
    for (uint32_t i = 0; i < view->count; i++) {
        if (view->splats[i].left <= view->splats[i].right) {
            from[drawn++] = i;
        }
    }
    for (int shift = 0; shift < 3 * BITS; shift += BITS) {
        uint32_t place[BUCKETS + 1] = {0};
        for (uint32_t n = 0; n < drawn; n++) {
            place[(view->splats[from[n]].depth_key >> shift) % BUCKETS + 1]++;
        }
        for (uint32_t b = 0; b < BUCKETS; b++) {
            place[b + 1] += place[b];
        }
        for (uint32_t n = 0; n < drawn; n++) {
            to[place[(view->splats[from[n]].depth_key >> shift) % BUCKETS]++] = from[n];
        }
        uint32_t *swap = from;
        from = to;
        to = swap;
    }
    *sorted = from;
    return drawn;
}

static bool make_room(splat_view *view, size_t entries)
{
    if (entries <= view->list_room) {
        return true;
    }
    free(view->list);
    view->list_room = entries + entries / 4;
    view->list = malloc(view->list_room * sizeof *view->list);
    if (view->list == NULL) {
        view->list_room = 0;
    }
    return view->list != NULL;
}

/* Counts the splat in every tile that it may reach, or enters it there with `fill`. */
static void visit_tiles(splat_view *view, uint32_t index, uint32_t *place, bool fill)
{
    const splat *s = &view->splats[index];
    for (int32_t y = s->top / SPLAT_TILE; y <= s->bottom / SPLAT_TILE; y++) {
        for (int32_t x = s->left / SPLAT_TILE; x <= s->right / SPLAT_TILE; x++) {
            uint32_t *at = &place[(uint32_t)y * view->across + (uint32_t)x];
            if (fill) {
                view->list[*at] = index;
            }
            (*at)++;
        }
    }
}

bool splat_view_bin(splat_view *view)
{
    uint32_t tiles = view->across * view->down, *sorted, drawn = sort(view, &sorted);
    /* counts are stored two places later, so that filling moves each tile's start to its end, the next tile's start */
    memset(view->first, 0, ((size_t)tiles + 2) * sizeof *view->first);
    for (uint32_t n = 0; n < drawn; n++) {
        visit_tiles(view, sorted[n], view->first + 2, false);
    }
    for (uint32_t t = 0; t < tiles; t++) {
        view->first[t + 2] += view->first[t + 1];
    }
    if (!make_room(view, view->first[tiles + 1])) {
        return false;
    }
    for (uint32_t n = 0; n < drawn; n++) {
        visit_tiles(view, sorted[n], view->first + 1, true);
    }
    return true;
}
