/* SPDX-License-Identifier: Apache-2.0 */
/* The pictures behind a chart's points, from the folders that eval --images wrote. */
#ifndef TRIM3R_TOOLS_CHART_PICTURES_H
#define TRIM3R_TOOLS_CHART_PICTURES_H

#include <stddef.h>
#include <stdint.h>

#include "study/chart/points.h"
#include "study/chart/texts.h"
#include "study/chart/view.h"

#define CHART_NO_PICTURE UINT32_MAX

typedef struct chart_picture {
    uint8_t *png; /* a PNG file's bytes, encoded here: nothing of a foreign file but its pixels */
    size_t bytes;
    uint32_t width, height;
} chart_picture;

/* What a cell shows; numbers of pictures or CHART_NO_PICTURE. */
typedef struct chart_shots {
    uint32_t render, target, mask;
} chart_shots;

typedef struct chart_pictures {
    chart_picture *pictures;
    uint32_t count, room;
    chart_shots *of_cell; /* one a cell of the points */
    uint32_t missing;     /* renders that the tables name and the folders lack */
    uint32_t left_out;    /* renders that there was no room for */
    size_t bytes;         /* of all PNG files */
    chart_texts paths;    /* looked up so far */
    uint32_t *of_path;
    uint32_t path_room;
} chart_pictures;

/* Reads a row's `picture`, and target.png and mask.png beside it, as FOLDER/picture or FOLDER/scene/picture, until
 * they are `most` bytes: the first case of every point first, then the second, and so on; of each case those of the
 * points on the front of a view before the others. folders: one for all tables, or one a table; none = no
 * pictures. 0, or -1 with "path: why" in error[]: a file that is no picture of 8 bits, a
 * render of another size than its target. */
int chart_pictures_gather(chart_pictures *pictures, const chart_points *points, const chart_view *view,
                          char *const *folders, uint32_t folder_count, size_t most, char *error, size_t error_bytes);
void chart_pictures_free(chart_pictures *pictures);

#endif
