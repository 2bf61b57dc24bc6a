#include "kernels/disparity_at.h"

#include <stddef.h>

#include "core/fixed.h"

/* A pixel's disparity and its confidence. */
typedef struct disparity {
    int32_t k_q7, confidence;
} disparity;

/* Whether two disparities are at most a pixel apart; T3R_NO_DISPARITY is farther from any. */
static inline bool beside(int32_t k, int32_t own)
{
    return (uint32_t)(k - own + (1 << T3R_DISPARITY_BITS)) <= 2u << T3R_DISPARITY_BITS;
}

static inline bool look_up(const t3r_disparity_plane *plane, int32_t x_q16, int32_t y_q16, disparity *found)
{
    const int64_t x = t3r_round_shift64((int64_t)x_q16 - plane->begin_q16, 8), y = t3r_round_shift64(y_q16, 8); /* Q8 */
    const int64_t width = plane->width, height = plane->height;
    const int64_t column = t3r_round_shift64(x, 8), row = t3r_round_shift64(y, 8);
    if (column < 0 || row < 0 || column >= width || row >= height) {
        return false;
    }
    const int32_t own = plane->disparity[row * width + column];
    const uint8_t confidence = plane->confidence[row * width + column];
    const bool matched = confidence != 0;
    if (own == T3R_NO_DISPARITY || (!matched && !plane->filled)) {
        return false;
    }
    *found = (disparity){own, matched ? T3R_MAX(confidence, 2) : 1};
    const int64_t left = x >> 8, top = y >> 8;
    if (left < 0 || top < 0 || left + 1 >= width || top + 1 >= height) {
        return true;
    }
    const uint16_t *k = plane->disparity + top * width + left, *below = k + width;
    const uint8_t *c = plane->confidence + top * width + left, *c_below = c + width;
    if (!beside(k[0], own) || !beside(k[1], own) || !beside(below[0], own) || !beside(below[1], own) ||
        (c[0] != 0) != matched || (c[1] != 0) != matched || (c_below[0] != 0) != matched ||
        (c_below[1] != 0) != matched) {
        return true;
    }
    const int32_t fx = (int32_t)(x & 255), fy = (int32_t)(y & 255);
    const int32_t upper = 256 * k[0] + fx * (k[1] - k[0]), lower = 256 * below[0] + fx * (below[1] - below[0]);
    found->k_q7 = (int32_t)t3r_round_shift64((int64_t)256 * upper + fy * (lower - upper), 16); /* below 2^15 2^16 */
    return true;
}

void t3r_disparity_at_c(const t3r_disparity_plane *given, const t3r_ray_places *places, uint32_t count,
                        t3r_disparities *out)
{
    const t3r_disparity_plane all = *given, *plane = &all; /* a copy, which the writes below cannot change */
    for (uint32_t i = 0; i < count; i++) {
        disparity found;
        const int32_t x_q16 = places->x_q16[i];
        if (places->z_q24[i] == 0 || !look_up(plane, x_q16, places->y_q16[i], &found)) {
            out->disparity_q16[i] = out->confidence[i] = out->own_q24[i] = out->other_q24[i] = 0;
            continue;
        }
        const int32_t apart = plane->first * 65536 + found.k_q7 * (1 << (16 - T3R_DISPARITY_BITS));
        out->disparity_q16[i] = apart;
        out->confidence[i] = found.confidence;
        out->own_q24[i] = t3r_divide_q24(&plane->scale, x_q16, 4);
        out->other_q24[i] = t3r_divide_q24(&plane->scale, (int64_t)x_q16 + (plane->right ? apart : -apart), 4);
    }
}
