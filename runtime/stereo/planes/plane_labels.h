/* SPDX-License-Identifier: Apache-2.0 */
/* The labels of a view's cells: surfaces that a cell may lie on, with the costs of each (SPEC.md, "Stereo: planes"). */
#ifndef T3R_PLANE_LABELS_H
#define T3R_PLANE_LABELS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/cut.h"
#include "depth/surface.h"
#include "plane_search.h"
#include "stereo/stereo.h"

/* Cells along a view's longer side */
#define T3R_LABEL_CELLS 32u
/* The planes; the depth that is there, matched or filled; and far away */
#define T3R_LABELS_MOST (T3R_PLANES_MOST + 2)

#define T3R_LABEL_GRID (T3R_LABEL_CELLS * T3R_LABEL_CELLS)
#define T3R_LABEL_BINS 512u /* of one over depth; the mean is T3R_LABEL_MEAN bins */
#define T3R_LABEL_MEAN 64
/* Bytes of the labels, aligned to 64 */
#define T3R_PLANE_LABELS_BYTES                                                                                         \
    (2 * T3R_UP_((size_t)T3R_LABEL_GRID * T3R_LABELS_MOST * 2) + T3R_UP_((size_t)T3R_LABEL_GRID * 2) +                 \
     T3R_UP_((size_t)T3R_LABEL_GRID * T3R_PLANES_MOST) + T3R_UP_((size_t)T3R_LABEL_BINS * 4))

/* A cost of 1 */
#define T3R_LABEL_ONE 64

typedef struct t3r_plane_labels {
    const t3r_view *view; /* filled */
    const t3r_planes *planes;
    int32_t middle_x, middle_y;
    uint32_t cell, columns, rows; /* side of a cell; numbers of cells, at most T3R_LABEL_CELLS */
    uint32_t count;               /* of labels: planes, then depth, then far */
    int64_t least_q8, high_q8;    /* one over depth, Q30 + 8: the least of labels; 97 % of matched pixels are below */
    int64_t spread_q8;            /* between 3 and 97 % of the matched pixels */
    int64_t far_q8, most_q8;      /* of the far label; what labels are clamped to */
    int32_t trust_q8;     /* in planes: 256 where they are thin, 0 where they are as thick as a part of the scene */
    uint16_t *cost, *sum; /* of each label of each cell: its own; with those of paths */
    uint16_t *share_q8;   /* of each cell: matched pixels */
    uint8_t *on;          /* whether matched pixels of each cell lie on each plane */
    uint32_t *histogram;
} t3r_plane_labels;

/* Prepares the labels of a filled view with at least one plane; takes T3R_PLANE_LABELS_BYTES of the cut. */
void t3r_plane_labels_begin(t3r_plane_labels *labels, const t3r_view *view, const t3r_planes *planes, t3r_cut *cut);

static inline uint32_t t3r_label_depth(const t3r_plane_labels *labels)
{
    return labels->planes->count;
}

/* Returns one over depth of a label at a pixel, Q30 + 8; at most 0 where the label is nowhere. */
static inline int64_t t3r_label_at_q8(const t3r_plane_labels *labels, uint32_t label, uint32_t u, uint32_t v)
{
    if (label < t3r_label_depth(labels)) {
        return t3r_plane_at_q8(&labels->planes->plane[label], (int32_t)u - labels->middle_x,
                               (int32_t)v - labels->middle_y);
    }
    if (label > t3r_label_depth(labels)) {
        return labels->far_q8;
    }
    const uint16_t depth = labels->view->depth[(size_t)v * labels->view->width + u];
    return depth == 0 ? 0 : t3r_inverse_depth_q30(depth) * 256;
}

static inline bool t3r_label_matched(const t3r_view *view, size_t i)
{
    return view->depth[i] != 0 && view->match_confidence[i] >= T3R_STEREO_LEAST;
}

/* Adds to a cost, Q6. */
static inline void t3r_label_add(const t3r_plane_labels *labels, uint32_t cell, uint32_t label, int64_t cost)
{
    uint16_t *own = &labels->cost[cell * labels->count + label];
    *own = (uint16_t)(*own + cost); /* below 2^11 together */
}

#endif
