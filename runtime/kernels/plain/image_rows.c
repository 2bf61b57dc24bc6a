/* SPDX-License-Identifier: Apache-2.0 */
#include "kernels/image_rows.h"

#include "core/fixed.h"

/* BT.601 limited range to R, G, B; coefficients Q13, each the real one within 2^-14. No int32 overflow: the
 * largest sum is below 2^23. */
static inline void yuv_pixel(int32_t y, int32_t u, int32_t v, uint8_t *r, uint8_t *g, uint8_t *b)
{
    int32_t luma = 9539 * (y - 16);
    int32_t red = luma + 13075 * (v - 128);
    int32_t green = luma - 3209 * (u - 128) - 6660 * (v - 128);
    int32_t blue = luma + 16525 * (u - 128);

    *r = (uint8_t)t3r_clamp32(t3r_round_shift32(red, 13), 0, 255);
    *g = (uint8_t)t3r_clamp32(t3r_round_shift32(green, 13), 0, 255);
    *b = (uint8_t)t3r_clamp32(t3r_round_shift32(blue, 13), 0, 255);
}

void t3r_packed_row_c(const uint8_t *restrict in, uint32_t count, uint32_t y_at, uint32_t u_at, uint8_t *restrict r,
                      uint8_t *restrict g, uint8_t *restrict b)
{
    for (uint32_t i = 0; i < count / 2; i++) {
        const uint8_t *pair = in + (size_t)4 * i;
        int32_t u = pair[u_at];
        int32_t v = pair[u_at + 2];
        yuv_pixel(pair[y_at], u, v, &r[2 * i], &g[2 * i], &b[2 * i]);
        yuv_pixel(pair[y_at + 2], u, v, &r[2 * i + 1], &g[2 * i + 1], &b[2 * i + 1]);
    }
}

void t3r_nv12_row_c(const uint8_t *restrict luma, const uint8_t *restrict chroma, uint32_t count, uint8_t *restrict r,
                    uint8_t *restrict g, uint8_t *restrict b)
{
    for (uint32_t i = 0; i < count / 2; i++) {
        int32_t u = chroma[2 * i];
        int32_t v = chroma[2 * i + 1];
        yuv_pixel(luma[2 * i], u, v, &r[2 * i], &g[2 * i], &b[2 * i]);
        yuv_pixel(luma[2 * i + 1], u, v, &r[2 * i + 1], &g[2 * i + 1], &b[2 * i + 1]);
    }
}

void t3r_triple_row_c(const uint8_t *restrict in, uint32_t count, uint8_t *restrict first, uint8_t *restrict second,
                      uint8_t *restrict third)
{
    for (uint32_t i = 0; i < count; i++) {
        first[i] = in[3 * i];
        second[i] = in[3 * i + 1];
        third[i] = in[3 * i + 2];
    }
}

t3r_box_walk t3r_box_sums_c(t3r_box_walk at, const uint8_t *restrict run, uint32_t count, uint32_t sample_units,
                            uint32_t box_units, uint32_t *restrict sums)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t value = run[i];
        uint32_t units = sample_units;
        /* at most units / box_units + 2 turns, and over a whole row of W samples and w boxes at most W + w */
        while (units >= at.left) {
            sums[at.box] += at.left * value;
            units -= at.left;
            at.box++;
            at.left = box_units;
        }
        if (units > 0) {
            sums[at.box] += units * value;
            at.left -= units;
        }
    }
    return at;
}

void t3r_weigh_row_c(uint32_t *restrict total, const uint32_t *restrict sums, uint32_t weight, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        total[i] += weight * sums[i];
    }
}

void t3r_divide_row_c(uint32_t *restrict total, uint32_t area, uint32_t count, uint8_t *restrict out)
{
    for (uint32_t i = 0; i < count; i++) {
        out[i] = (uint8_t)((total[i] + area / 2) / area);
        total[i] = 0;
    }
}
