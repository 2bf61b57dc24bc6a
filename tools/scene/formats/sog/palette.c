/* Bisecting K-means: the cells with the largest sums of squared distances to their means are split in two until there
 * are enough. A cell of equal rows is never split. */
#include "scene/formats/sog/palette.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 3 }; /* rounds of K-means with two means, per split */

typedef struct cell {
    uint32_t first, count; /* range of the order; never empty */
    uint32_t axis;         /* axis of the largest variance */
    double error;          /* sum of squared distances to the mean; exactly 0 if and only if all rows are equal */
} cell;

typedef struct rows {
    const int16_t *numbers;
    size_t stride;
    uint32_t width;
    uint32_t *order; /* the rows of a cell are consecutive */
} rows;

static const int16_t *row_of(const rows *r, uint32_t place)
{
    return r->numbers + r->order[place] * r->stride;
}

/* Computes the mean, the error and the axis of a cell. Differences to the first row are below 2^17 and there are at
 * most 2^24 rows, so sums of squares stay below 2^58. */
static void survey(const rows *r, cell *c, double *mean)
{
    int64_t sums[PALETTE_WIDTH_MOST] = {0}, squares[PALETTE_WIDTH_MOST] = {0};
    const int16_t *first = row_of(r, c->first);
    for (uint32_t i = 0; i < c->count; i++) {
        const int16_t *row = row_of(r, c->first + i);
        for (uint32_t k = 0; k < r->width; k++) {
            const int64_t from_first = row[k] - first[k];
            sums[k] += from_first;
            squares[k] += from_first * from_first;
        }
    }
    double largest = -1;
    c->error = 0;
    for (uint32_t k = 0; k < r->width; k++) {
        const double sum = (double)sums[k], spread = (double)squares[k] - sum * sum / c->count;
        mean[k] = first[k] + sum / c->count;
        c->error += spread;
        c->axis = spread > largest ? k : c->axis;
        largest = fmax(largest, spread);
    }
}

/* Moves the rows that are at least as near to `low` as to `high` to the front, and returns their number. */
static uint32_t part(const rows *r, const cell *c, const double *low, const double *high)
{
    double normal[PALETTE_WIDTH_MOST], bound = 0;
    for (uint32_t k = 0; k < r->width; k++) {
        normal[k] = high[k] - low[k];
        bound += normal[k] * (high[k] + low[k]) / 2;
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        const int16_t *row = row_of(r, c->first + i);
        double along = 0;
        for (uint32_t k = 0; k < r->width; k++) {
            along += normal[k] * row[k];
        }
        if (along <= bound) {
            const uint32_t moved = r->order[c->first + i];
            r->order[c->first + i] = r->order[c->first + kept];
            r->order[c->first + kept++] = moved;
        }
    }
    return kept;
}

/* Starts a split at the mean along the axis, rounded down: the least row is not above it, the largest is. */
static void begin_parts(const double *mean, uint32_t axis, double *low, double *high)
{
    memcpy(low, mean, PALETTE_WIDTH_MOST * sizeof *low);
    memcpy(high, mean, PALETTE_WIDTH_MOST * sizeof *high);
    low[axis] = floor(mean[axis]) - 1;
    high[axis] = floor(mean[axis]) + 1;
}

/* Splits a cell whose rows are not all equal; neither part is empty. */
static void split(const rows *r, cell *low, cell *high)
{
    double mean[PALETTE_WIDTH_MOST] = {0}, low_mean[PALETTE_WIDTH_MOST], high_mean[PALETTE_WIDTH_MOST];
    const cell whole = *low;
    survey(r, low, mean);
    begin_parts(mean, whole.axis, low_mean, high_mean);
    for (int round = 0; round <= ROUNDS; round++) {
        uint32_t kept = part(r, &whole, low_mean, high_mean);
        if (kept == 0 || kept == whole.count) { /* can happen by rounding, for nearly equal rows */
            begin_parts(mean, whole.axis, low_mean, high_mean);
            kept = part(r, &whole, low_mean, high_mean);
            round = ROUNDS;
        }
        *low = (cell){.first = whole.first, .count = kept};
        *high = (cell){.first = whole.first + kept, .count = whole.count - kept};
        survey(r, low, low_mean);
        survey(r, high, high_mean);
    }
}

/* Splits cells whose error is above a threshold, which starts at half of the whole error and is halved each round.
 * Unequal rows of whole numbers have an error of at least 1/2. */
static uint32_t split_all(const rows *r, uint32_t most, cell *cells)
{
    uint32_t count = 1;
    for (double bound = cells[0].error; bound > 0.1 && count < most; bound /= 2) {
        for (uint32_t i = 0; i < count; i++) {
            while (cells[i].error > bound / 2 && count < most) {
                split(r, &cells[i], &cells[count]);
                count++;
            }
        }
    }
    return count;
}

int palette_make(const int16_t *numbers, uint32_t count, size_t stride, uint32_t width, uint32_t most, palette *out)
{
    const rows r = {numbers, stride, width, malloc(count * sizeof *r.order)};
    cell *cells = malloc(most * sizeof *cells);
    *out = (palette){.width = width,
                     .means = malloc((size_t)most * width * sizeof *out->means),
                     .labels = malloc(count * sizeof *out->labels)};
    const int is_made = r.order != NULL && cells != NULL && out->means != NULL && out->labels != NULL;
    if (is_made) {
        for (uint32_t i = 0; i < count; i++) {
            r.order[i] = i;
        }
        cells[0] = (cell){.first = 0, .count = count};
        survey(&r, &cells[0], out->means);
        out->rows = split_all(&r, most, cells);
        for (uint32_t i = 0; i < out->rows; i++) {
            survey(&r, &cells[i], out->means + (size_t)i * width);
            for (uint32_t k = 0; k < cells[i].count; k++) {
                out->labels[r.order[cells[i].first + k]] = (uint16_t)i;
            }
        }
    } else {
        palette_free(out);
    }
    free(cells);
    free(r.order);
    return is_made ? 0 : -1;
}

void palette_free(palette *made)
{
    free(made->means);
    free(made->labels);
    *made = (palette){0};
}
