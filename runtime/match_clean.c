#include "match_clean.h"

#include <stdbool.h>

#include "fixed.h"

#define ONE (1 << T3R_DISPARITY_BITS)
/* A step of luma that a surface rarely has inside. */
#define EDGE 16
/* Directions of eight in which a hole must end: what is open is not filled. */
#define SURROUNDED 5

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

/* --- agreement -------------------------------------------------------------------------------------------------- */

static bool near(uint16_t a, uint16_t b)
{
    return t3r_abs32((int32_t)a - b) <= ONE;
}

/* The column in the other plane that a pixel's disparity leads to; -1: outside. */
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

/* --- speckles --------------------------------------------------------------------------------------------------- */

enum { UNSEEN, QUEUED, LARGE };

static bool joined(const plane *p, size_t a, size_t b)
{
    return p->confidence[b] != 0 && near(p->disparity[a], p->disparity[b]);
}

/* Follows the region that begins at `start` until it ends or `least` pixels of it are known, or until it meets a pixel
 * of one known to be large. Returns how many pixels are in the queue; *large tells which. */
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

uint32_t t3r_match_speckles(const t3r_match *match, uint32_t side)
{
    const plane p = plane_of(match, side);
    const uint32_t pixels = p.width * p.height, least = T3R_MATCH_LEAST_REGION(match->width, match->height);
    uint32_t *queue = match->work, removed = 0;
    uint8_t *mark = (uint8_t *)(queue + least);
    for (uint32_t i = 0; i < pixels; i++) {
        mark[i] = UNSEEN;
    }
    /* Every pixel is queued once: afterwards it is known to belong to a large region, or has no confidence any more. */
    for (uint32_t i = 0; i < pixels; i++) {
        if (p.confidence[i] == 0 || mark[i] != UNSEEN) {
            continue;
        }
        bool large;
        const uint32_t queued = explore(&p, i, least, mark, queue, &large);
        for (uint32_t n = 0; n < queued; n++) {
            mark[queue[n]] = LARGE;
            if (!large) {
                p.confidence[queue[n]] = 0;
            }
        }
        removed += large ? 0 : queued;
    }
    return removed;
}

/* --- filling ---------------------------------------------------------------------------------------------------- */

static const int8_t directions[8][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, 1}, {1, -1}, {-1, 1}};

/* The disparities first met from (x, y) in the eight directions, rising; those behind an edge only if `across`. */
static uint32_t surroundings(const plane *p, int32_t x, int32_t y, bool across, uint16_t found[8])
{
    uint32_t count = 0;
    for (int d = 0; d < 8; d++) {
        const int32_t dx = directions[d][0], dy = directions[d][1];
        size_t before = (size_t)y * p->width + (size_t)x;
        for (int32_t i = 1; i <= T3R_MATCH_REACH; i++) {
            const int32_t u = x + i * dx, v = y + i * dy;
            if (u < 0 || v < 0 || u >= (int32_t)p->width || v >= (int32_t)p->height) {
                break;
            }
            const size_t at = (size_t)v * p->width + (size_t)u;
            if (p->luma[at] == 0 || (!across && t3r_abs32(p->luma[at] - p->luma[before]) > EDGE)) {
                break;
            }
            before = at;
            if (p->confidence[at] != 0) {
                uint32_t place = count++;
                for (; place > 0 && found[place - 1] > p->disparity[at]; place--) {
                    found[place] = found[place - 1];
                }
                found[place] = p->disparity[at];
                break;
            }
        }
    }
    return count;
}

/* Whether some trusted pixel of the other plane leads here: then this place was seen twice, and matched wrongly. */
static bool is_seen(const t3r_match *match, uint32_t side, const plane *other, int32_t x, uint32_t y)
{
    for (int32_t k = 0; k < (int32_t)match->disparities; k++) {
        const int32_t column = other_column(match, side, x, k);
        if (column >= 0) {
            const size_t at = (size_t)y * other->width + (size_t)column;
            if (other->confidence[at] != 0 && t3r_abs32(other->disparity[at] - k * ONE) <= ONE / 2) {
                return true;
            }
        }
    }
    return false;
}

void t3r_match_fill(const t3r_match *match, uint32_t side)
{
    const plane p = plane_of(match, side), other = plane_of(match, 1 - side);
    for (uint32_t y = 0; y < p.height; y++) {
        for (uint32_t x = 0; x < p.width; x++) {
            const size_t at = (size_t)y * p.width + x;
            uint16_t found[8];
            if (p.confidence[at] != 0) {
                continue;
            }
            p.disparity[at] = T3R_NO_DISPARITY;
            if (p.luma[at] == 0) {
                continue;
            }
            uint32_t count = surroundings(&p, (int32_t)x, (int32_t)y, true, found);
            if (count < SURROUNDED) {
                continue;
            }
            /* Without crossing an edge if that leads anywhere. */
            count = surroundings(&p, (int32_t)x, (int32_t)y, false, found);
            if (count < 2) {
                count = surroundings(&p, (int32_t)x, (int32_t)y, true, found);
            }
            const bool seen = is_seen(match, side, &other, (int32_t)x, y);
            p.disparity[at] = found[seen ? count / 2 : 1];
        }
    }
}
