#include "scene/scene_order.h"

#include <math.h>
#include <stdlib.h>

enum { BITS = 10 };

typedef struct placed {
    uint32_t code, index;
} placed;

static int compare_codes(const void *a, const void *b)
{
    const placed *x = a, *y = b;
    return x->code != y->code ? (x->code > y->code) - (x->code < y->code)
                              : (x->index > y->index) - (x->index < y->index);
}

/* Moves bit i of each coordinate to bit 3 i, 3 i + 1 or 3 i + 2. */
static uint32_t interleave(const uint32_t cell[3])
{
    uint32_t code = 0;
    for (uint32_t bit = 0; bit < BITS; bit++) {
        for (uint32_t axis = 0; axis < 3; axis++) {
            code |= (cell[axis] >> bit & 1) << (3 * bit + axis);
        }
    }
    return code;
}

uint32_t *scene_order_morton(const scene_source *source)
{
    const uint32_t count = source->scene->count;
    const t3r_gaussian *gaussians = source->scene->gaussians;
    placed *order = malloc((count + (size_t)1) * sizeof *order);
    uint32_t *indices = malloc((count + (size_t)1) * sizeof *indices);
    if (order == NULL || indices == NULL) {
        free(order);
        free(indices);
        return NULL;
    }
    int64_t low[3] = {INT64_MAX, INT64_MAX, INT64_MAX}, size = 1;
    for (uint32_t i = 0; i < count; i++) {
        for (int axis = 0; axis < 3; axis++) {
            const int64_t at = gaussians[i].position_q20[axis];
            low[axis] = at < low[axis] ? at : low[axis];
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        for (int axis = 0; axis < 3; axis++) {
            const int64_t from = gaussians[i].position_q20[axis] - low[axis] + 1;
            size = from > size ? from : size;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t cell[3];
        for (int axis = 0; axis < 3; axis++) {
            cell[axis] = (uint32_t)(((gaussians[i].position_q20[axis] - low[axis]) << BITS) / size);
        }
        order[i] = (placed){interleave(cell), i};
    }
    qsort(order, count, sizeof *order, compare_codes);
    for (uint32_t i = 0; i < count; i++) {
        indices[i] = order[i].index;
    }
    free(order);
    return indices;
}
