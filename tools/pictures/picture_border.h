/* SPDX-License-Identifier: Apache-2.0 */
/* Finds a border of one colour around all pictures of a set, as undistorted and rectified pictures often have. */
#ifndef TRIM3R_TOOLS_PICTURE_BORDER_H
#define TRIM3R_TOOLS_PICTURE_BORDER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cjson/cJSON.h>

#include "pictures/picture.h"
#include "trim3r_host.h"

/* The part of a picture inside its border. */
typedef struct picture_inner {
    uint32_t width, height; /* of the whole picture; 0: no border was found */
    t3r_crop part;
} picture_inner;

/* Sums over a line of pixels along one side, in all pictures. */
typedef struct border_line {
    bool uniform;      /* every pixel has the border's colour */
    uint64_t off;      /* number of pixels of another colour */
    uint64_t contrast; /* sum of differences from the border's colour */
} border_line;

#define BORDER_SIDES 4u /* left, top, right, bottom */

typedef struct border_search {
    uint32_t width, height, channels, pictures;
    int32_t colour[3];
    border_line *lines[BORDER_SIDES];
    bool possible; /* no picture seen so far excludes a border */
} border_search;

/* Begins a search; border_search_end() ends it. */
void border_search_begin(border_search *search);
/* Looks at the next picture, of 8 bits. Once search->possible is false, the others need not be read. Returns 0, or -1
 * without memory. */
int border_search_add(border_search *search, const picture *p);
/* Returns what lies inside the border. There is one if each of the four sides begins, in every picture, with one line
 * or more of one colour, at most a sixteenth of the picture, and if within four lines after these at least half of the
 * pixels have another colour: the edge of a wall or of the sky is not that straight, and a vignette is no step. Lines
 * between the border's colour and the picture's, which differ from the border by less than 3/4 of what the next line
 * does, count as border. */
picture_inner border_search_end(border_search *search);

/* Prints a line on the border that is left out, if there is one. */
void picture_border_print(const picture_inner *inner);
/* Adds "border": its pixels on the left, top, right and bottom. */
void picture_border_add_json(const picture_inner *inner, cJSON *object);

#endif
