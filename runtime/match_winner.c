#include "match_winner.h"

#include "fixed.h"

#define ONE (1 << T3R_DISPARITY_BITS)

/* The least of a pixel's sums and, the first that has it. */
static int16_t least_of(const int16_t *sums, uint32_t count, uint32_t *first)
{
    int16_t least = INT16_MAX;
    count &= ~(T3R_PATH_LANES - 1);
    for (uint32_t k = 0; k < count; k++) {
        least = sums[k] < least ? sums[k] : least;
    }
    uint32_t k = 0;
    while (sums[k] != least) {
        k++; /* ends before count: the least is one of them */
    }
    *first = k;
    return least;
}

/* Every candidate of a left pixel is one of some right pixel: these keep the least they have seen, the first of equals.
 * best, at: those of the right pixels by falling column, from the one of k = 0 on. */
static void offer(const int16_t *sums, uint32_t count, int16_t *restrict best, int16_t *restrict at)
{
    count &= ~(T3R_PATH_LANES - 1);
    for (uint32_t k = 0; k < count; k++) {
        int16_t old = best[k], older = at[k], sum = sums[k];
        at[k] = sum < old ? (int16_t)k : older;
        best[k] = sum < old ? sum : old;
    }
}

/* k in Q7, moved towards the cheaper neighbour: the vertex of two lines of opposite slope through three sums. */
static uint16_t refined(uint32_t k, int32_t before, int32_t least, int32_t after)
{
    int32_t steeper = T3R_MAX(before, after) - least;
    int32_t shift = steeper <= 0 ? 0 : (int32_t)t3r_round_div64((int64_t)(before - after) * ONE, 2 * steeper);
    return (uint16_t)((int32_t)(k * ONE) + shift);
}

/* The least of the sums but for k - 1, k and k + 1. */
static int16_t second_of(int16_t *sums, uint32_t count, uint32_t k)
{
    uint32_t from = k > 0 ? k - 1 : 0, to = T3R_MIN(k + 2, count), first;
    int16_t kept[3];
    for (uint32_t i = from; i < to; i++) {
        kept[i - from] = sums[i];
        sums[i] = INT16_MAX;
    }
    int16_t second = least_of(sums, count, &first);
    for (uint32_t i = from; i < to; i++) {
        sums[i] = kept[i - from];
    }
    return second;
}

void t3r_match_winners(const t3r_match *match, uint32_t y, int16_t *sums, int16_t *work)
{
    const uint32_t width = match->width, count = match->disparities;
    const uint32_t right = (uint32_t)T3R_MATCH_RIGHT(width, count);
    const uint8_t *luma = match->luma[0] + (size_t)y * width, *luma_right = match->luma[1] + (size_t)y * right;
    uint16_t *disparity = match->disparity[0] + (size_t)y * width;
    uint16_t *disparity_right = match->disparity[1] + (size_t)y * right;
    uint8_t *confidence = match->confidence + (size_t)y * width;
    int16_t *best = work, *at = work + right;

    for (uint32_t j = 0; j < right; j++) {
        best[j] = INT16_MAX;
        at[j] = 0;
    }
    for (uint32_t x = 0; x < width; x++) {
        int16_t *s = sums + (size_t)x * count;
        uint32_t k;
        disparity[x] = T3R_NO_DISPARITY;
        confidence[x] = 0;
        if (luma[x] == 0) {
            continue;
        }
        offer(s, count, best + (width - 1 - x), at + (width - 1 - x));
        int16_t least = least_of(s, count, &k);
        if (luma_right[x + count - 1 - k] == 0) {
            continue;
        }
        int16_t second = second_of(s, count, k);
        int32_t margin = second - least;
        confidence[x] = (uint8_t)T3R_MIN(255, margin * 256 / T3R_MAX(second, (int16_t)1));
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
