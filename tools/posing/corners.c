/* SPDX-License-Identifier: Apache-2.0 */
#include "posing/corners.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "posing/descriptor.h"
#include "posing/pyramid.h"

#define SIDE_LEAST 48u
#define CELL 24u             /* pixels: corners are taken in turn from cells, so that all of the picture has some */
#define RESPONSE_LEAST 20000 /* of a corner: above what noise of one grey level makes */

/* One picture of the pyramid. */
typedef struct level {
    uint8_t *grey;
    uint32_t width, height;
    int64_t *response;
} level;

/* ---- Harris' measure -------------------------------------------------------------------------------------------- */

/* Products of the gradients, 3 x 3 Sobel: |g| <= 4 x 255, so products are below 2^20. */
static void gradient_products(const level *l, int32_t *xx, int32_t *xy, int32_t *yy)
{
    size_t w = l->width;
    for (uint32_t y = 1; y + 1 < l->height; y++) {
        for (uint32_t x = 1; x + 1 < w; x++) {
            const uint8_t *p = l->grey + y * w + x, *up = p - w, *down = p + w;
            int32_t gx = up[1] + 2 * p[1] + down[1] - up[-1] - 2 * p[-1] - down[-1];
            int32_t gy = down[-1] + 2 * down[0] + down[1] - up[-1] - 2 * up[0] - up[1];
            xx[y * w + x] = gx * gx;
            xy[y * w + x] = gx * gy;
            yy[y * w + x] = gy * gy;
        }
    }
}

/* The binomial average over 5 x 5, weights 1 4 6 4 1 each way. work: a plane. The sum is below 2^28. */
static void smooth(int32_t *plane, uint32_t width, uint32_t height, int32_t *work)
{
    size_t w = width;
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 2; x + 2 < width; x++) {
            const int32_t *p = plane + y * w + x;
            work[y * w + x] = p[-2] + 4 * p[-1] + 6 * p[0] + 4 * p[1] + p[2];
        }
    }
    for (uint32_t y = 2; y + 2 < height; y++) {
        for (uint32_t x = 2; x + 2 < width; x++) {
            const int32_t *p = work + y * w + x;
            plane[y * w + x] = (*(p - 2 * w) + 4 * *(p - w) + 6 * p[0] + 4 * p[w] + p[2 * w] + 128) >> 8;
        }
    }
}

/* det - trace^2 / 16, entries below 2^20: within 2^42. 0 where the window does not fit. */
static int measure(level *l)
{
    size_t pixels = (size_t)l->width * l->height;
    int32_t *planes = calloc(pixels, 4 * sizeof *planes);
    if (planes == NULL) {
        return -1;
    }
    int32_t *xx = planes, *xy = planes + pixels, *yy = planes + 2 * pixels, *work = planes + 3 * pixels;
    gradient_products(l, xx, xy, yy);
    smooth(xx, l->width, l->height, work);
    smooth(xy, l->width, l->height, work);
    smooth(yy, l->width, l->height, work);
    for (uint32_t y = 3; y + 3 < l->height; y++) {
        for (uint32_t x = 3; x + 3 < l->width; x++) {
            size_t i = (size_t)y * l->width + x;
            int64_t trace = (int64_t)xx[i] + yy[i];
            l->response[i] = (int64_t)xx[i] * yy[i] - (int64_t)xy[i] * xy[i] - (trace * trace >> 4);
        }
    }
    free(planes);
    return 0;
}

/* ---- choosing --------------------------------------------------------------------------------------------------- */

typedef struct candidate {
    int64_t response;
    uint32_t x, y, cell, rank; /* rank: how many of its cell are stronger */
} candidate;

/* The strongest of its 5 x 5; of equal ones the first. */
static bool is_peak(const level *l, uint32_t x, uint32_t y)
{
    int64_t here = l->response[(size_t)y * l->width + x];
    for (uint32_t v = y - 2; v <= y + 2; v++) {
        for (uint32_t u = x - 2; u <= x + 2; u++) {
            int64_t there = l->response[(size_t)v * l->width + u];
            bool before = v < y || (v == y && u < x);
            if (there > here || (there == here && before)) {
                return false;
            }
        }
    }
    return true;
}

static int by_cell(const void *a, const void *b)
{
    const candidate *p = a, *q = b;
    if (p->cell != q->cell) {
        return p->cell < q->cell ? -1 : 1;
    }
    if (p->response != q->response) {
        return p->response > q->response ? -1 : 1;
    }
    return p->y != q->y ? (p->y < q->y ? -1 : 1) : (p->x > q->x) - (p->x < q->x);
}

static int by_rank(const void *a, const void *b)
{
    const candidate *p = a, *q = b;
    return p->rank != q->rank ? (p->rank < q->rank ? -1 : 1) : by_cell(a, b);
}

/* Peaks of a level, the strongest of each cell first, then the second ones ... NULL when memory is out. */
static candidate *peaks(const level *l, uint32_t *count)
{
    uint32_t columns = l->width / CELL + 1;
    /* peaks are at least three pixels apart in x or y */
    candidate *found = malloc(((size_t)l->width * l->height / 4 + 1) * sizeof *found);
    *count = 0;
    for (uint32_t y = DESCRIPTOR_BORDER; found != NULL && y + DESCRIPTOR_BORDER < l->height; y++) {
        for (uint32_t x = DESCRIPTOR_BORDER; x + DESCRIPTOR_BORDER < l->width; x++) {
            int64_t response = l->response[(size_t)y * l->width + x];
            if (response >= RESPONSE_LEAST && is_peak(l, x, y)) {
                found[(*count)++] = (candidate){response, x, y, y / CELL * columns + x / CELL, 0};
            }
        }
    }
    if (found == NULL || *count == 0) {
        return found;
    }
    qsort(found, *count, sizeof *found, by_cell);
    for (uint32_t i = 1; i < *count; i++) {
        found[i].rank = found[i].cell == found[i - 1].cell ? found[i - 1].rank + 1 : 0;
    }
    qsort(found, *count, sizeof *found, by_rank);
    return found;
}

/* The peak of the parabola through three values of which the middle one is the largest, in Q8, at most half a pixel. */
static int32_t parabola_q8(int64_t before, int64_t here, int64_t after)
{
    int64_t bend = 2 * here - before - after; /* below 2^44 */
    return bend <= 0 ? 0 : (int32_t)((after - before) * 128 / bend);
}

/* A place of a level in the whole picture, Q8: pixel centres and edges scale alike. */
static int32_t whole_q8(int64_t at_q8, uint32_t side, uint32_t whole)
{
    return (int32_t)(((2 * at_q8 + 256) * whole / side - 256) / 2);
}

static int find_in_level(level *l, uint32_t number, uint32_t width, uint32_t height, uint32_t most, corner *corners,
                         uint32_t *count)
{
    size_t pixels = (size_t)l->width * l->height;
    l->response = calloc(pixels, sizeof *l->response);
    uint16_t *smoothed = malloc(pixels * sizeof *smoothed);
    uint32_t found_count = 0;
    candidate *found = l->response != NULL && smoothed != NULL && measure(l) == 0 ? peaks(l, &found_count) : NULL;
    int status = found != NULL ? 0 : -1;
    if (status == 0) {
        descriptor_smooth(l->grey, l->width, l->height, smoothed);
    }
    for (uint32_t i = 0; i < found_count && i < most; i++) {
        const candidate *c = &found[i];
        const int64_t *r = l->response + (size_t)c->y * l->width + c->x;
        corner *out = &corners[(*count)++];
        int64_t x_q8 = (int64_t)c->x * 256 + parabola_q8(r[-1], r[0], r[1]);
        int64_t y_q8 = (int64_t)c->y * 256 + parabola_q8(*(r - l->width), r[0], r[l->width]);
        out->x_q8 = whole_q8(x_q8, l->width, width);
        out->y_q8 = whole_q8(y_q8, l->height, height);
        out->level = number;
        descriptor_compare(l->grey, smoothed, l->width, c->x, c->y, out->comparisons);
    }
    free(found);
    free(smoothed);
    free(l->response);
    l->response = NULL;
    return status;
}

int corners_find(const uint8_t *grey, uint32_t width, uint32_t height, corner *corners, uint32_t *count)
{
    /* in proportion to the levels' areas' roots, 4/5 each: parts of 1 + 4/5 + ... */
    static const uint32_t share_percent[CORNER_LEVELS] = {27, 22, 17, 14, 11, 9};
    int status = 0;
    level l = {.width = width, .height = height};
    *count = 0;
    l.grey = malloc((size_t)width * height);
    if (l.grey == NULL) {
        return -1;
    }
    memcpy(l.grey, grey, (size_t)width * height);
    uint32_t owed = 0; /* what the levels before had too few corners for */
    for (uint32_t i = 0; i < CORNER_LEVELS && status == 0 && l.width >= SIDE_LEAST && l.height >= SIDE_LEAST; i++) {
        uint32_t before = *count, most = CORNERS_MOST * share_percent[i] / 100 + owed;
        status = find_in_level(&l, i, width, height, most, corners, count);
        owed = most - (*count - before);
        level up = {.width = pyramid_side(l.width), .height = pyramid_side(l.height)};
        up.grey = malloc((size_t)up.width * up.height);
        if (up.grey == NULL) {
            status = -1;
            break;
        }
        pyramid_reduce(l.grey, l.width, l.height, up.grey);
        free(l.grey);
        l = up;
    }
    free(l.grey);
    return status;
}

uint32_t corners_differ(const corner *a, const corner *b)
{
    uint32_t differ = 0;
    for (int i = 0; i < 4; i++) {
        differ += (uint32_t)__builtin_popcountll(a->comparisons[i] ^ b->comparisons[i]);
    }
    return differ;
}
