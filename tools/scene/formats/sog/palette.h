/* Rows of 16-bit numbers as indices into a palette of rows. */
#ifndef TRIM3R_TOOLS_PALETTE_H
#define TRIM3R_TOOLS_PALETTE_H

#include <stddef.h>
#include <stdint.h>

#include "scene/harmonics.h"

enum { PALETTE_ROWS_MOST = 65536, PALETTE_WIDTH_MOST = 3 * HARMONICS_REST_MOST };

typedef struct palette {
    uint32_t rows;    /* at most as many as asked for; fewer where that many differ */
    uint32_t width;   /* numbers of a row */
    double *means;    /* rows x width */
    uint16_t *labels; /* the palette's row for each row of numbers */
} palette;

/* Of `count` rows, at least 1, that are `stride` numbers apart; `width` is 1..PALETTE_WIDTH_MOST and `most`
 * 1..PALETTE_ROWS_MOST. By bisecting K-means in a fixed order: the same numbers give the same palette. 0, and
 * palette_free() is due; or -1 without memory. */
int palette_make(const int16_t *numbers, uint32_t count, size_t stride, uint32_t width, uint32_t most, palette *out);
void palette_free(palette *made);

#endif
