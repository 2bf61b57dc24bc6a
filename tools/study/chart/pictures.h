/* SPDX-License-Identifier: Apache-2.0 */
/* The pictures of a chart's points, from the folders that eval --images wrote. */
#ifndef TRIM3R_TOOLS_CHART_PICTURES_H
#define TRIM3R_TOOLS_CHART_PICTURES_H

#include <stddef.h>
#include <stdint.h>

#include "study/chart/points.h"
#include "study/chart/texts.h"
#include "study/chart/view.h"

#define CHART_NO_PICTURE UINT32_MAX

typedef struct chart_picture {
    uint8_t *png; /* a PNG file encoded here, from the pixels of the file that was read */
    size_t bytes;
    uint32_t width, height;
} chart_picture;

/* Picture numbers of a cell, or CHART_NO_PICTURE. */
typedef struct chart_shots {
    uint32_t render, target, mask;
} chart_shots;

typedef struct chart_pictures {
    chart_picture *pictures;
    uint32_t count;
    size_t room;
    chart_shots *of_cell; /* one per cell of the points */
    uint32_t missing;     /* renders that the tables name and the folders lack */
    uint32_t left_out;    /* renders that did not fit */
    size_t bytes;         /* of all PNG files together */
    chart_texts paths;    /* looked up so far */
    uint32_t *of_path;
    size_t path_room;
} chart_pictures;

/* Reads a row's `picture`, and target.png and mask.png next to it, as FOLDER/picture or FOLDER/scene/picture, up to
 * `most` bytes in all. The first cases of all points have priority, then the second ones, and so on; within a round,
 * the points on the front of a view. folders: one for all tables, or one for each table; none: no pictures. Returns 0,
 * or -1 with "path: why" in error[]: a file is not an 8-bit picture, or a render differs in size from its target. */
int chart_pictures_gather(chart_pictures *pictures, const chart_points *points, const chart_view *view,
                          char *const *folders, uint32_t folder_count, size_t most, char *error, size_t error_bytes);
void chart_pictures_free(chart_pictures *pictures);

#endif
