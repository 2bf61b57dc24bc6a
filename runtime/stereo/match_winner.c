#include "match_winner.h"

#include "core/fixed.h"

#define ONE (1 << T3R_DISPARITY_BITS)

/* 0, 1, 2...: loops that compare k in 16 bits read it here. */
typedef struct counting {
    int16_t k[T3R_PATH_MOST];
} counting;

static int16_t least_of(const int16_t *sums, size_t count)
{
    int16_t least = INT16_MAX;
    for (size_t i = 0; i < count; i++) {
        least = sums[i] < least ? sums[i] : least;
    }
    return least;
}

/* The first k whose sum is `least`. */
static int16_t first_of(const int16_t *sums, const int16_t *restrict k, size_t count, int16_t least)
{
    int16_t first = INT16_MAX;
    for (size_t i = 0; i < count; i++) {
        int16_t other = (int16_t) - (sums[i] != least); /* all bits, or none */
        int16_t at = (int16_t)((k[i] | other) & INT16_MAX);
        first = at < first ? at : first;
    }
    return first;
}

/* The least of the sums but for best - 1, best and best + 1. */
static int16_t second_of(const int16_t *sums, const int16_t *restrict k, size_t count, int16_t best)
{
    const int16_t below = (int16_t)(best - 1), above = (int16_t)(best + 1);
    int16_t second = INT16_MAX;
    for (size_t i = 0; i < count; i++) {
        int16_t sum = sums[i], here = k[i];
        int16_t before = here < below ? sum : INT16_MAX, after = here > above ? sum : INT16_MAX;
        int16_t least = before < after ? before : after;
        second = least < second ? least : second;
    }
    return second;
}

/* Every candidate of a left pixel is one of some right pixel: these keep the least they have seen, the first of equals.
 * best, at: those of the right pixels by falling column, from the one of k = 0 on. */
static void offer(const int16_t *sums, const int16_t *k, size_t count, int16_t *restrict best, int16_t *restrict at)
{
    for (size_t i = 0; i < count; i++) {
        int16_t old = best[i], older = at[i], sum = sums[i], here = k[i];
        at[i] = sum < old ? here : older;
        best[i] = sum < old ? sum : old;
    }
}

/* k in Q7, moved towards the cheaper neighbour: the vertex of two lines of opposite slope through three sums. */
static uint16_t refined(uint32_t k, int32_t before, int32_t least, int32_t after)
{
    int32_t steeper = T3R_MAX(before, after) - least;
    int32_t shift = steeper <= 0 ? 0 : t3r_round_div32((before - after) * ONE, 2 * steeper);
    return (uint16_t)((int32_t)(k * ONE) + shift);
}

void t3r_match_winners(const t3r_match *match, uint32_t y, const int16_t *sums, int16_t *work)
{
    const uint32_t width = match->width, count = match->disparities & ~(T3R_PATH_LANES - 1);
    const uint32_t right = (uint32_t)T3R_MATCH_RIGHT(width, count);
    const uint8_t *luma = match->luma[0] + (size_t)y * width, *luma_right = match->luma[1] + (size_t)y * right;
    uint16_t *disparity = match->disparity[0] + (size_t)y * width;
    uint16_t *disparity_right = match->disparity[1] + (size_t)y * right;
    uint8_t *confidence = match->confidence[0] + (size_t)y * width;
    int16_t *best = work, *at = work + right;
    counting order;

    for (uint32_t k = 0; k < count; k++) {
        order.k[k] = (int16_t)k;
    }

    for (uint32_t j = 0; j < right; j++) {
        best[j] = INT16_MAX;
        at[j] = 0;
    }
    for (uint32_t x = 0; x < width; x++) {
        const int16_t *s = sums + (size_t)x * count;
        disparity[x] = T3R_NO_DISPARITY;
        confidence[x] = 0;
        if (luma[x] == 0) {
            continue;
        }
        offer(s, order.k, count, best + (width - 1 - x), at + (width - 1 - x));
        int16_t least = least_of(s, count);
        uint32_t k = (uint32_t)first_of(s, order.k, count, least);
        if (luma_right[x + count - 1 - k] == 0) {
            continue;
        }
        int16_t second = second_of(s, order.k, count, (int16_t)k);
        int32_t margin = second - least;
        confidence[x] = (uint8_t)t3r_clamp32(margin * 256 / T3R_MAX(second, (int16_t)1), 1, 255);
        disparity[x] = k == 0 || k + 1 == count ? (uint16_t)(k * ONE) : refined(k, s[k - 1], least, s[k + 1]);
    }
    for (uint32_t n = 0; n < right; n++) {
        uint32_t j = right - 1 - n;
        disparity_right[j] = T3R_NO_DISPARITY;
        if (luma_right[j] == 0 || best[n] == INT16_MAX) {
            continue;
        }
        uint32_t k = (uint32_t)at[n], x = width - 1 + k - n; /* n = width - 1 - x + k */
        const int16_t *s = sums + (size_t)x * count + k;
        bool inside = k > 0 && k + 1 < count && x > 0 && x + 1 < width && luma[x - 1] != 0 && luma[x + 1] != 0;
        disparity_right[j] = inside ? refined(k, s[-(ptrdiff_t)count - 1], best[n], s[count + 1]) : (uint16_t)(k * ONE);
    }
}
