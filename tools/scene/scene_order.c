/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_order.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

enum { BITS = 10 };

/* Shells about the centre: the innermost reaches NEAR typical distances, each other twice as far as the one before. Far
 * Gaussians would make the cells of the others wide, and share their bounds in formats that have some for each part. */
enum { SHELLS = 32, NEAR = 2 };

typedef struct placed {
    uint32_t shell, code, index;
} placed;

/* The cube about the means of a shell. */
typedef struct cube {
    bool is_used;
    double low[3], high[3];
} cube;

static int compare_codes(const void *a, const void *b)
{
    const placed *x = a, *y = b;
    if (x->shell != y->shell) {
        return (x->shell > y->shell) - (x->shell < y->shell);
    }
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

static uint32_t shell_of(const scene_source *source, const double position[3])
{
    double away = 0;
    for (int axis = 0; axis < 3; axis++) {
        away = fmax(away, fabs(position[axis] - source->centre[axis]));
    }
    const double times = away / (NEAR * source->typical);
    return times <= 1 ? 0 : (uint32_t)fmin(ceil(log2(times)), SHELLS - 1);
}

/* Finds the shell of each row, and the cubes about them, with a row at a time. */
static void bound(const scene_source *source, placed *order, cube cubes[SHELLS])
{
    for (uint32_t i = 0; i < source->rows->count; i++) {
        scene_row row;
        scene_source_row(source, i, &row);
        order[i] = (placed){.shell = shell_of(source, row.position), .index = i};
        cube *c = &cubes[order[i].shell];
        for (int axis = 0; axis < 3; axis++) {
            c->low[axis] = c->is_used ? fmin(c->low[axis], row.position[axis]) : row.position[axis];
            c->high[axis] = c->is_used ? fmax(c->high[axis], row.position[axis]) : row.position[axis];
        }
        c->is_used = true;
    }
}

static double side_of(const cube *c)
{
    return fmax(c->high[0] - c->low[0], fmax(c->high[1] - c->low[1], c->high[2] - c->low[2]));
}

static uint32_t code_of(const cube *c, const double position[3])
{
    const double side = side_of(c);
    uint32_t cell[3];
    for (int axis = 0; axis < 3; axis++) {
        const double share = side > 0 ? (position[axis] - c->low[axis]) / side : 0;
        cell[axis] = (uint32_t)fmin(ldexp(share, BITS), (1 << BITS) - 1);
    }
    return interleave(cell);
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
    cube cubes[SHELLS] = {0};
    bound(source, order, cubes);
    for (uint32_t i = 0; i < count; i++) {
        scene_row row;
        scene_source_row(source, i, &row);
        order[i].code = code_of(&cubes[order[i].shell], row.position);
    }
    qsort(order, count, sizeof *order, compare_codes);
    for (uint32_t i = 0; i < count; i++) {
        indices[i] = order[i].index;
    }
    free(order);
    return indices;
}
