/* SPDX-License-Identifier: Apache-2.0 */
#include "posing/pyramid.h"

uint32_t pyramid_side(uint32_t side)
{
    return side * 4 / 5;
}

/* Source pixels under an output pixel along one axis, in units of 1/to of a pixel: [at from, (at + 1) from). */
typedef struct span {
    uint32_t first, last;   /* pixels, both included */
    uint32_t head, between; /* weights of the first and of those that are whole; the last has the rest */
    uint32_t tail;
} span;

static span span_of(uint32_t at, uint32_t from, uint32_t to)
{
    uint32_t begin = at * from, end = begin + from; /* below 2^24 */
    span s = {.first = begin / to, .last = (end - 1) / to, .between = to};
    s.head = s.first == s.last ? from : (s.first + 1) * to - begin;
    s.tail = end - s.last * to;
    return s;
}

static uint32_t weight(const span *s, uint32_t at)
{
    return at == s->first ? s->head : at == s->last ? s->tail : s->between;
}

void pyramid_reduce(const uint8_t *grey, uint32_t width, uint32_t height, uint8_t *out)
{
    uint32_t columns = pyramid_side(width), rows = pyramid_side(height);
    for (uint32_t y = 0; y < rows; y++) {
        span down = span_of(y, height, rows);
        for (uint32_t x = 0; x < columns; x++) {
            span across = span_of(x, width, columns);
            /* the weights' sum is width x height, at most 2^24; times 255 */
            uint64_t sum = 0, area = (uint64_t)width * height;
            for (uint32_t sy = down.first; sy <= down.last; sy++) {
                for (uint32_t sx = across.first; sx <= across.last; sx++) {
                    sum += (uint64_t)weight(&down, sy) * weight(&across, sx) * grey[(uint64_t)sy * width + sx];
                }
            }
            out[(uint64_t)y * columns + x] = (uint8_t)((sum + area / 2) / area);
        }
    }
}
