#include "match_winner.h"

#include <stdbool.h>

#include "core/fixed.h"

#define ONE (1 << T3R_DISPARITY_BITS)

/* Refines k to Q7, towards the cheaper neighbour: the vertex of two lines of opposite slope through three sums. */
static uint16_t refined(uint32_t k, int32_t before, int32_t least, int32_t after)
{
    int32_t steeper = T3R_MAX(before, after) - least;
    int32_t shift = steeper <= 0 ? 0 : t3r_round_div32((before - after) * ONE, 2 * steeper);
    return (uint16_t)((int32_t)(k * ONE) + shift);
}

void t3r_match_winners(const t3r_match *match, uint32_t y, const int16_t *sums, int16_t *work)
{
    const uint32_t width = match->width, count = match->disparities;
    const uint32_t right = (uint32_t)T3R_MATCH_RIGHT(width, count);
    const uint8_t *luma = match->luma[0] + (size_t)y * width, *luma_right = match->luma[1] + (size_t)y * right;
    uint16_t *disparity = match->disparity[0] + (size_t)y * width;
    uint16_t *disparity_right = match->disparity[1] + (size_t)y * right;
    uint8_t *confidence = match->confidence[0] + (size_t)y * width;
    /* The rows hold the index and the second least sum until they hold disparities. */
    const t3r_winner_row row = {.width = width,
                                .disparities = count,
                                .luma = luma,
                                .sums = sums,
                                .first = disparity,
                                .second = disparity_right,
                                .best = work,
                                .at = work + right};
    match->kernels->winner_row(&row);
    for (uint32_t x = 0; x < width; x++) {
        const int16_t *s = sums + (size_t)x * count;
        const uint32_t k = row.first[x];
        const int32_t least = s[k], second = row.second[x];
        const bool matched = luma[x] != 0 && luma_right[x + count - 1 - k] != 0;
        const bool inside = k > 0 && k + 1 < count;
        confidence[x] = 0;
        disparity[x] = T3R_NO_DISPARITY;
        if (matched) {
            confidence[x] = (uint8_t)t3r_clamp32((second - least) * 256 / T3R_MAX(second, 1), 1, 255);
            disparity[x] = inside ? refined(k, s[k - 1], least, s[k + 1]) : (uint16_t)(k * ONE);
        }
    }
    for (uint32_t n = 0; n < right; n++) {
        uint32_t j = right - 1 - n;
        disparity_right[j] = T3R_NO_DISPARITY;
        if (luma_right[j] == 0 || row.best[n] == INT16_MAX) {
            continue;
        }
        uint32_t k = (uint32_t)row.at[n], x = width - 1 + k - n; /* n = width - 1 - x + k */
        const int16_t *s = sums + (size_t)x * count + k;
        bool inside = k > 0 && k + 1 < count && x > 0 && x + 1 < width && luma[x - 1] != 0 && luma[x + 1] != 0;
        disparity_right[j] =
            inside ? refined(k, s[-(ptrdiff_t)count - 1], row.best[n], s[count + 1]) : (uint16_t)(k * ONE);
    }
}
