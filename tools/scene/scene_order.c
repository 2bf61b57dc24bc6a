/* SPDX-License-Identifier: Apache-2.0 */
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

/* Finds the low corner and the side of the cube about all means, with a row at a time. */
static double bound(const scene_source *source, double low[3])
{
    double high[3], side = 0;
    for (uint32_t i = 0; i < source->rows->count; i++) {
        scene_row row;
        scene_source_row(source, i, &row);
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = i == 0 ? row.position[axis] : fmin(low[axis], row.position[axis]);
            high[axis] = i == 0 ? row.position[axis] : fmax(high[axis], row.position[axis]);
            side = fmax(side, high[axis] - low[axis]);
        }
    }
    return side;
}

uint32_t *scene_order_morton(const scene_source *source)
{
    const uint32_t count = source->rows->count;
    placed *order = malloc((count + (size_t)1) * sizeof *order);
    uint32_t *indices = malloc((count + (size_t)1) * sizeof *indices);
    if (order == NULL || indices == NULL) {
        free(order);
        free(indices);
        return NULL;
    }
    double low[3];
    const double side = bound(source, low);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t cell[3];
        scene_row row;
        scene_source_row(source, i, &row);
        for (int axis = 0; axis < 3; axis++) {
            const double share = side > 0 ? (row.position[axis] - low[axis]) / side : 0;
            cell[axis] = (uint32_t)fmin(ldexp(share, BITS), (1 << BITS) - 1);
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
