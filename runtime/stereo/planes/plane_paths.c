/* SPDX-License-Identifier: Apache-2.0 */
#include "plane_paths.h"

#include "core/fixed.h"
#include "core/memory.h"

/* A change of label between neighbours costs 5. */
#define CHANGE (5 * T3R_LABEL_ONE)

/* Continues a path to the next cell. path: of each label, below 2^12. */
static void step(const uint16_t *cost, uint32_t count, uint32_t *path, uint16_t *sum)
{
    uint32_t least = path[0];
    for (uint32_t l = 1; l < count; l++) {
        least = T3R_MIN(least, path[l]);
    }
    for (uint32_t l = 0; l < count; l++) {
        path[l] = cost[l] + T3R_MIN(path[l] - least, (uint32_t)CHANGE);
        sum[l] = (uint16_t)(sum[l] + path[l]);
    }
}

/* Follows the paths along all rows or columns, both ways. */
static void follow(const t3r_plane_labels *labels, uint32_t lines, uint32_t length, uint32_t line, uint32_t next)
{
    for (uint32_t i = 0; i < 2 * lines; i++) {
        uint32_t path[T3R_LABELS_MOST] = {0};
        for (uint32_t k = 0; k < length; k++) {
            const uint32_t at = (i % 2 == 0 ? k : length - 1 - k) * next + i / 2 * line;
            step(labels->cost + (size_t)at * labels->count, labels->count, path,
                 labels->sum + (size_t)at * labels->count);
        }
    }
}

void t3r_plane_paths(const t3r_plane_labels *labels)
{
    memset(labels->sum, 0, (size_t)labels->columns * labels->rows * labels->count * sizeof *labels->sum);
    follow(labels, labels->rows, labels->columns, labels->columns, 1);
    follow(labels, labels->columns, labels->rows, 1, labels->columns);
}
