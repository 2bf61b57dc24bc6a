/* Represents rows of 16-bit numbers by indices into a palette of rows. */
#ifndef TRIM3R_TOOLS_PALETTE_H
#define TRIM3R_TOOLS_PALETTE_H

#include <stddef.h>
#include <stdint.h>

#include "scene/harmonics.h"

enum { PALETTE_ROWS_MOST = 65536, PALETTE_WIDTH_MOST = 3 * HARMONICS_REST_MOST };

typedef struct palette {
    uint32_t rows;    /* at most the requested number; fewer if there are fewer different rows */
    uint32_t width;   /* numbers per row */
    double *means;    /* rows x width */
    uint16_t *labels; /* palette row of each row of numbers */
} palette;

/* Makes a palette of `count` rows, at least 1, which are `stride` numbers apart; `width` is 1..PALETTE_WIDTH_MOST and
 * `most` 1..PALETTE_ROWS_MOST. Bisecting K-means in a fixed order: the same numbers give the same palette. Returns 0,
 * after which palette_free() is due; or -1 without memory. */
int palette_make(const int16_t *numbers, uint32_t count, size_t stride, uint32_t width, uint32_t most, palette *out);
void palette_free(palette *made);

#endif
