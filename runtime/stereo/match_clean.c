/* SPDX-License-Identifier: Apache-2.0 */
#include "match_clean.h"

#include <stdbool.h>

#include "core/fixed.h"

#define ONE (1 << T3R_DISPARITY_BITS)
/* A step of luma larger than a surface usually has. */
#define EDGE 16
/* Directions of eight in which a hole must end: open areas are not filled. */
#define SURROUNDED 4u

typedef struct plane {
    uint32_t width, height;
    const uint8_t *luma;
    uint16_t *disparity;
    uint8_t *confidence;
} plane;

static plane plane_of(const t3r_match *match, uint32_t side)
{
    uint32_t width = side == 0 ? match->width : (uint32_t)T3R_MATCH_RIGHT(match->width, match->disparities);
    return (plane){width, match->height, match->luma[side], match->disparity[side], match->confidence[side]};
}

static bool near(uint16_t a, uint16_t b)
{
    return t3r_abs32((int32_t)a - b) <= ONE;
}

/* Returns the column of the other plane that a pixel's disparity leads to, -1 outside. */
static int32_t other_column(const t3r_match *match, uint32_t side, int32_t x, int32_t k)
{
    int32_t shift = (int32_t)match->disparities - 1 - k;
    int32_t other = side == 0 ? x + shift : x - shift;
    int32_t width = side == 0 ? (int32_t)T3R_MATCH_RIGHT(match->width, match->disparities) : (int32_t)match->width;
    return other < 0 || other >= width ? -1 : other;
}

static int32_t whole(uint16_t disparity)
{
    return t3r_round_shift32(disparity, T3R_DISPARITY_BITS);
}

void t3r_match_agree(const t3r_match *match)
{
    plane left = plane_of(match, 0), right = plane_of(match, 1);
    for (uint32_t y = 0; y < match->height; y++) {
        uint16_t *own = left.disparity + (size_t)y * left.width, *other = right.disparity + (size_t)y * right.width;
        uint8_t *confidence = left.confidence + (size_t)y * left.width;
        uint8_t *confidence_right = right.confidence + (size_t)y * right.width;
        for (uint32_t x = 0; x < left.width; x++) {
            int32_t j = own[x] == T3R_NO_DISPARITY ? -1 : other_column(match, 0, (int32_t)x, whole(own[x]));
            if (j < 0 || other[j] == T3R_NO_DISPARITY || !near(own[x], other[j])) {
                confidence[x] = 0;
            }
        }
        for (uint32_t j = 0; j < right.width; j++) {
            int32_t x = other[j] == T3R_NO_DISPARITY ? -1 : other_column(match, 1, (int32_t)j, whole(other[j]));
            bool agrees = x >= 0 && confidence[x] != 0 && near(own[x], other[j]);
            confidence_right[j] = agrees ? confidence[x] : 0;
        }
    }
}

enum { UNSEEN, QUEUED, LARGE };

static bool joined(const plane *p, size_t a, size_t b)
{
    return p->confidence[b] != 0 && near(p->disparity[a], p->disparity[b]);
}

/* Follows the region that begins at `start` until it ends, has `least` pixels, or meets a pixel of a region known to
 * be large. Returns the number of queued pixels; *large: whether the region is large. */
static uint32_t explore(const plane *p, uint32_t start, uint32_t least, uint8_t *mark, uint32_t *queue, bool *large)
{
    uint32_t queued = 1;
    queue[0] = start;
    mark[start] = QUEUED;
    *large = false;
    for (uint32_t done = 0; done < queued; done++) {
        const uint32_t at = queue[done], x = at % p->width, y = at / p->width;
        const uint32_t beside[4] = {at - 1, at + 1, at - p->width, at + p->width};
        const bool inside[4] = {x > 0, x + 1 < p->width, y > 0, y + 1 < p->height};
        for (int i = 0; i < 4; i++) {
            if (!inside[i] || mark[beside[i]] == QUEUED || !joined(p, at, beside[i])) {
                continue;
            }
            if (mark[beside[i]] == LARGE || queued == least) {
                *large = true;
                return queued;
            }
            mark[beside[i]] = QUEUED;
            queue[queued++] = beside[i];
        }
    }
    *large = queued >= least;
    return queued;
}

/* Removes the region that begins at `start` if it is too small. Returns the number of pixels removed. */
static uint32_t remove_speckle(const plane *p, uint32_t start, uint32_t least, uint8_t *mark, uint32_t *queue)
{
    bool large;
    const uint32_t queued = explore(p, start, least, mark, queue, &large);
    for (uint32_t n = 0; n < queued; n++) {
        mark[queue[n]] = LARGE;
        if (!large) {
            p->confidence[queue[n]] = 0;
        }
    }
    return large ? 0 : queued;
}

uint32_t t3r_match_speckles(const t3r_match *match, uint32_t side)
{
    const plane p = plane_of(match, side);
    const uint32_t pixels = p.width * p.height, least = T3R_MATCH_LEAST_REGION(match->width, match->height);
    uint32_t *queue = match->work, removed = 0;
    uint8_t *mark = (uint8_t *)(queue + least);
    for (uint32_t i = 0; i < pixels; i++) {
        mark[i] = UNSEEN;
    }
    /* Every pixel is queued at most once: then it either belongs to a large region or has lost its confidence. */
    for (uint32_t row = 0; row < pixels; row += p.width) {
        for (uint32_t i = row; i < row + p.width; i++) {
            if (p.confidence[i] == 0 || mark[i] != UNSEEN) {
                continue;
            }
            if (i > row && mark[i - 1] == LARGE && joined(&p, i, i - 1)) { /* the usual case */
                mark[i] = LARGE;
            } else {
                removed += remove_speckle(&p, i, least, mark, queue);
            }
        }
    }
    return removed;
}

static inline void sort(uint16_t *a, uint16_t *b)
{
    const int16_t x = (int16_t)*a, y = (int16_t)*b; /* disparities are below 2^15, and vectors compare signed numbers */
    *a = (uint16_t)(x < y ? x : y);
    *b = (uint16_t)(x < y ? y : x);
}

/* Computes the medians of 3 x 3 for columns 1..width - 2 of the middle row, by Paeth's network. */
static void medians(const uint16_t *above, const uint16_t *middle, const uint16_t *below, uint32_t width,
                    uint16_t *restrict out)
{
    for (size_t x = 1; x + 1 < width; x++) {
        uint16_t a = above[x - 1], b = above[x], c = above[x + 1], d = middle[x - 1], e = middle[x];
        uint16_t f = middle[x + 1], g = below[x - 1], h = below[x], i = below[x + 1];
        sort(&b, &c), sort(&e, &f), sort(&h, &i);
        sort(&a, &b), sort(&d, &e), sort(&g, &h);
        sort(&b, &c), sort(&e, &f), sort(&h, &i);
        sort(&a, &d), sort(&f, &i), sort(&e, &h);
        sort(&d, &g), sort(&b, &e), sort(&c, &f);
        sort(&e, &h), sort(&e, &c), sort(&g, &e);
        sort(&e, &c);
        out[x] = e;
    }
}

static inline uint8_t lesser(uint8_t a, uint8_t b)
{
    return a < b ? a : b;
}

/* Computes the least of nine confidences in the same way. */
static void least_of_nine(const uint8_t *above, const uint8_t *middle, const uint8_t *below, uint32_t width,
                          uint8_t *restrict out)
{
    for (size_t x = 1; x + 1 < width; x++) {
        uint8_t left = lesser(above[x - 1], lesser(middle[x - 1], below[x - 1]));
        uint8_t here = lesser(above[x], lesser(middle[x], below[x]));
        uint8_t right = lesser(above[x + 1], lesser(middle[x + 1], below[x + 1]));
        out[x] = lesser(left, lesser(here, right));
    }
}

void t3r_match_smooth(const t3r_match *match, uint32_t side)
{
    const plane p = plane_of(match, side);
    uint16_t *before = match->work, *here = before + p.width, *median = here + p.width;
    uint8_t *least = (uint8_t *)(median + p.width);
    for (uint32_t y = 0; y < p.height; y++) {
        uint16_t *row = p.disparity + (size_t)y * p.width;
        for (uint32_t x = 0; x < p.width; x++) {
            here[x] = row[x]; /* unsmoothed */
        }
        if (y > 0 && y + 1 < p.height) {
            const uint8_t *c = p.confidence + (size_t)y * p.width;
            medians(before, here, row + p.width, p.width, median);
            least_of_nine(c - p.width, c, c + p.width, p.width, least);
            for (size_t x = 1; x + 1 < p.width; x++) {
                const uint16_t own = row[x], other = median[x];
                row[x] = least[x] != 0 ? other : own;
            }
        }
        uint16_t *next = before;
        before = here;
        here = next;
    }
}

static const int8_t directions[8][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, 1}, {1, -1}, {-1, 1}};

/* Disparities in rising order. */
typedef struct gathering {
    uint32_t count;
    uint16_t disparity[8];
} gathering;

static void gather(gathering *g, uint16_t disparity)
{
    uint32_t place = g->count++;
    for (; place > 0 && g->disparity[place - 1] > disparity; place--) {
        g->disparity[place] = g->disparity[place - 1];
    }
    g->disparity[place] = disparity;
}

/* Finds the first trusted disparities from (x, y) in the eight directions: all of them, and those without a luma edge
 * on the way. known: distance to the first one in each of the first three directions. */
static void look_around(const plane *p, int32_t x, int32_t y, const uint8_t known[3], gathering *all, gathering *open)
{
    all->count = open->count = 0;
    /* ends when fewer than SURROUNDED can still be found */
    for (uint32_t d = 0; d < 8 && d - all->count <= 8 - SURROUNDED; d++) {
        const int32_t dx = directions[d][0], dy = directions[d][1];
        const int32_t columns = dx == 0 ? T3R_MATCH_REACH : dx < 0 ? x : (int32_t)p->width - 1 - x;
        const int32_t rows = dy == 0 ? T3R_MATCH_REACH : dy < 0 ? y : (int32_t)p->height - 1 - y;
        const int32_t reach = d < 3 && known[d] > T3R_MATCH_REACH ? 0 : T3R_MATCH_REACH;
        const int32_t most = T3R_MIN(reach, T3R_MIN(columns, rows));
        const ptrdiff_t step = (ptrdiff_t)dy * (ptrdiff_t)p->width + dx;
        ptrdiff_t at = (ptrdiff_t)y * (ptrdiff_t)p->width + x;
        bool crossed = false;
        for (int32_t i = 0; i < most; i++) {
            const uint8_t before = p->luma[at];
            at += step;
            crossed |= t3r_abs32(p->luma[at] - before) > EDGE;
            if (p->confidence[at] != 0) {
                gather(all, p->disparity[at]);
                if (!crossed) {
                    gather(open, p->disparity[at]);
                }
                break;
            }
        }
    }
}

/* Marks the pixels of a row that a trusted pixel of the other plane leads to. Both pictures show them; those without
 * confidence are mismatches. */
static void mark_seen(const t3r_match *match, uint32_t side, const plane *p, const plane *other, uint32_t y,
                      uint8_t *seen)
{
    const uint16_t *disparity = other->disparity + (size_t)y * other->width;
    const uint8_t *confidence = other->confidence + (size_t)y * other->width;
    for (uint32_t x = 0; x < p->width; x++) {
        seen[x] = 0;
    }
    for (uint32_t x = 0; x < other->width; x++) {
        const int32_t column = confidence[x] == 0 ? -1 : other_column(match, 1 - side, (int32_t)x, whole(disparity[x]));
        if (column >= 0) {
            seen[column] = 1;
        }
    }
}

static uint8_t one_farther(uint8_t distance)
{
    return (uint8_t)(distance == UINT8_MAX ? distance : distance + 1);
}

void t3r_match_fill(const t3r_match *match, uint32_t side)
{
    const plane p = plane_of(match, side), other = plane_of(match, 1 - side);
    /* for each column: seen by the other picture, distance to a trusted pixel to the right, and above */
    uint8_t *seen = match->work, *ahead = seen + p.width, *above = ahead + p.width;
    for (uint32_t x = 0; x < p.width; x++) {
        above[x] = UINT8_MAX;
    }
    for (uint32_t y = 0; y < p.height; y++) {
        const size_t row = (size_t)y * p.width;
        const uint8_t *confidence = p.confidence + row;
        uint8_t behind = UINT8_MAX, distance = UINT8_MAX;
        mark_seen(match, side, &p, &other, y, seen);
        for (uint32_t x = p.width; x-- > 0;) {
            ahead[x] = distance;
            distance = confidence[x] != 0 ? 1 : one_farther(distance);
        }
        for (uint32_t x = 0; x < p.width; x++) {
            gathering all, open;
            if (confidence[x] == 0) {
                p.disparity[row + x] = T3R_NO_DISPARITY;
                if (p.luma[row + x] != 0) {
                    const uint8_t known[3] = {behind, ahead[x], above[x]};
                    look_around(&p, (int32_t)x, (int32_t)y, known, &all, &open);
                    if (all.count >= SURROUNDED) {
                        const gathering *of = open.count >= 2 ? &open : &all;
                        p.disparity[row + x] = of->disparity[seen[x] ? of->count / 2 : 1];
                    }
                }
            }
            behind = confidence[x] != 0 ? 1 : one_farther(behind);
            above[x] = confidence[x] != 0 ? 1 : one_farther(above[x]);
        }
    }
}
