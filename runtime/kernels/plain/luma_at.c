#include "kernels/luma_at.h"

#include <stdbool.h>

#include "core/fixed.h"

static inline uint8_t between(const t3r_luma_picture *picture, int32_t u_q16, int32_t v_q16)
{
    const int32_t width = (int32_t)picture->width, height = (int32_t)picture->height;
    const int32_t u = t3r_clamp32(t3r_round_shift32(u_q16, 8), 0, (width - 1) << 8);
    const int32_t v = t3r_clamp32(t3r_round_shift32(v_q16, 8), 0, (height - 1) << 8);
    const int32_t x = u >> 8, y = v >> 8, fx = u & 255, fy = v & 255;
    const int32_t right = T3R_MIN(x + 1, width - 1), below = T3R_MIN(y + 1, height - 1);
    const uint8_t *a = picture->luma + (size_t)y * (size_t)width, *b = picture->luma + (size_t)below * (size_t)width;
    const int32_t top = 256 * a[x] + fx * (a[right] - a[x]), bottom = 256 * b[x] + fx * (b[right] - b[x]);
    return (uint8_t)T3R_MAX(t3r_round_shift32(256 * top + fy * (bottom - top), 16), 1);
}

void t3r_luma_at_c(const t3r_luma_picture *given, const t3r_ray_places *places, uint32_t count, uint8_t *out)
{
    const t3r_luma_picture all = *given, *picture = &all; /* a copy, which the writes below cannot change */
    for (uint32_t i = 0; i < count; i++) {
        /* positions far outside are clamped to 32 bits, which is still outside */
        const int32_t u = places->x_q16[i], v = places->y_q16[i];
        const uint32_t x = (uint32_t)(((u >> 15) + 1) >> 1), y = (uint32_t)(((v >> 15) + 1) >> 1);
        const bool seen = places->z_q24[i] != 0 && x < picture->width && y < picture->height &&
                          picture->luma[(size_t)y * picture->width + x] != 0;
        out[i] = 0;
        if (seen) {
            out[i] = between(picture, u, v);
        }
    }
}
