/* SPDX-License-Identifier: Apache-2.0 */
/* Nearest neighbours by a k-d tree: `order` is an array of indices in which the middle of each range splits the range
 * along one axis. */
#include "study/rivals/tuning/neighbours.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

typedef struct tree {
    const splat_model *model;
    uint32_t *order;
    uint8_t *axis; /* along which the element at this place of `order` splits its range */
} tree;

static const double *centre(const tree *t, uint32_t index)
{
    return &t->model->parameters[(size_t)index * SPLAT_PARAMETERS + SPLAT_POSITION];
}

static double coordinate(const tree *t, uint32_t place, int axis)
{
    return centre(t, t->order[place])[axis];
}

static uint8_t widest_axis(const tree *t, uint32_t first, uint32_t end)
{
    double width[3];
    for (int k = 0; k < 3; k++) {
        double low = DBL_MAX, high = -DBL_MAX;
        for (uint32_t i = first; i < end; i++) {
            low = fmin(low, coordinate(t, i, k));
            high = fmax(high, coordinate(t, i, k));
        }
        width[k] = high - low;
    }
    return width[0] >= width[1] && width[0] >= width[2] ? 0 : width[1] >= width[2] ? 1 : 2;
}

static void swap(tree *t, uint32_t a, uint32_t b)
{
    const uint32_t kept = t->order[a];
    t->order[a] = t->order[b];
    t->order[b] = kept;
}

/* Hoare's selection: afterwards no element of the range before `middle` is greater than it, none after it less. */
static void select_middle(tree *t, uint32_t first, uint32_t end, uint32_t middle, int axis)
{
    int64_t low = first, high = (int64_t)end - 1;
    while (low < high) {
        const double pivot = coordinate(t, (uint32_t)((low + high) / 2), axis);
        int64_t i = low, j = high;
        while (i <= j) {
            while (coordinate(t, (uint32_t)i, axis) < pivot) {
                i++;
            }
            while (coordinate(t, (uint32_t)j, axis) > pivot) {
                j--;
            }
            if (i <= j) {
                swap(t, (uint32_t)i++, (uint32_t)j--);
            }
        }
        if (middle <= j) {
            high = j;
        } else if (middle >= i) {
            low = i;
        } else {
            return;
        }
    }
}

/* Sorts a range into a tree. Each call halves the range, so the depth is at most 32. */
static void build(tree *t, uint32_t first, uint32_t end)
{
    if (end - first < 2) {
        return;
    }
    const uint32_t middle = first + (end - first) / 2;
    t->axis[middle] = widest_axis(t, first, end);
    select_middle(t, first, end, middle, t->axis[middle]);
    build(t, first, middle);
    build(t, middle + 1, end);
}

/* The nearest neighbours of one Gaussian. */
typedef struct nearest {
    uint32_t of;
    double square[NEIGHBOURS]; /* of the distances, rising; DBL_MAX: none */
} nearest;

static void meet(nearest *n, double square)
{
    for (int k = 0; k < NEIGHBOURS; k++) {
        if (square < n->square[k]) {
            const double farther = n->square[k];
            n->square[k] = square;
            square = farther;
        }
    }
}

static void search(const tree *t, uint32_t first, uint32_t end, nearest *n)
{
    if (first >= end) {
        return;
    }
    const uint32_t middle = first + (end - first) / 2, index = t->order[middle];
    const double *own = centre(t, n->of), *other = centre(t, index);
    double square = 0;
    for (int k = 0; k < 3; k++) {
        square += (own[k] - other[k]) * (own[k] - other[k]);
    }
    if (index != n->of) {
        meet(n, square);
    }
    const int axis = t->axis[middle];
    const double beyond = own[axis] - other[axis];
    const bool before = beyond < 0;
    search(t, before ? first : middle + 1, before ? middle : end, n);
    if (beyond * beyond < n->square[NEIGHBOURS - 1]) {
        search(t, before ? middle + 1 : first, before ? end : middle, n);
    }
}

static double distance_of(const tree *t, uint32_t index)
{
    nearest n = {index, {DBL_MAX, DBL_MAX, DBL_MAX}};
    double sum = 0;
    int count = 0;
    search(t, 0, t->model->count, &n);
    for (; count < NEIGHBOURS && n.square[count] < DBL_MAX; count++) {
        sum += n.square[count];
    }
    return count == 0 ? 0 : sqrt(sum / count);
}

bool neighbour_distances(const splat_model *model, double *distance)
{
    const size_t room = (size_t)model->count + 1;
    tree t = {.model = model, .order = malloc(room * sizeof *t.order), .axis = calloc(room, sizeof *t.axis)};
    const bool done = t.order != NULL && t.axis != NULL;
    for (uint32_t i = 0; i < model->count && done; i++) {
        t.order[i] = i;
    }
    if (done) {
        build(&t, 0, model->count);
    }
    for (uint32_t i = 0; i < model->count && done; i++) {
        distance[i] = distance_of(&t, i);
    }
    free(t.order);
    free(t.axis);
    return done;
}

bool neighbour_widen(splat_model *model)
{
    double *distance = malloc(((size_t)model->count + 1) * sizeof *distance);
    const bool done = distance != NULL && neighbour_distances(model, distance);
    for (uint32_t i = 0; i < model->count && done; i++) {
        double *scale = &model->parameters[(size_t)i * SPLAT_PARAMETERS + SPLAT_LOG_SCALE];
        const double growth = distance[i] > 0 ? log(distance[i]) - fmax(scale[0], fmax(scale[1], scale[2])) : 0;
        for (int k = 0; k < 3; k++) {
            scale[k] += growth;
        }
    }
    free(distance);
    return done;
}
