/* SPDX-License-Identifier: Apache-2.0 */
#include "splat_surface.h"

#include "core/fixed.h"
#include "kernels/project_parts.h"

#define DEEP_Q24 (1 << 28)     /* most standard deviation along the axis, in parts of the depth: 16 */
#define STEEPEST_Q24 (1 << 28) /* most slope: 16 times the depth a pixel */
#define PRODUCT_BITS 30        /* of covariances, which multiply entries of the conic */

/* Computes the row of W F that is along the axis, in parts of the mean's depth, Q24. */
static void depth_row(const t3r_projection *p, const t3r_gaussian *g, int32_t z_q20, int32_t row_q24[3])
{
    const int32_t *w = p->world_to_camera_q30 + 6;
    const t3r_reciprocal inverse = t3r_invert((uint32_t)z_q20);
    const int32_t shift = T3R_MIN(g->factor_exponent + inverse.lz - 32, 30);
    for (int j = 0; j < 3; j++) {
        /* below 2^47; less 16 bits, times rn: below 2^62 */
        const int64_t sum =
            (int64_t)w[0] * g->factor[j] + (int64_t)w[1] * g->factor[3 + j] + (int64_t)w[2] * g->factor[6 + j];
        int64_t part = t3r_round_shift64(sum, 16) * inverse.rn;
        if (shift > 0) {
            part = t3r_clamp64(part, -DEEP_Q24, DEEP_Q24);
        }
        row_q24[j] = (int32_t)t3r_clamp64(t3r_scale64(part, shift), -DEEP_Q24, DEEP_Q24);
    }
}

static int64_t dot(const int32_t a[3], const int32_t b[3])
{
    return (int64_t)a[0] * b[0] + (int64_t)a[1] * b[1] + (int64_t)a[2] * b[2];
}

/* Returns 2 (a x + b y): a and b of the conic, x and y the covariances of a pixel's coordinates with depth, Q36 less
 * `reduced` bits. */
static int32_t slope_q24(int32_t a_q30, int64_t x, int32_t b_q30, int64_t y, uint32_t reduced)
{
    const int64_t sum = a_q30 * x + b_q30 * y; /* entries are at most 2^30.8: below 2^63 */
    return (int32_t)t3r_clamp64(t3r_round_shift64(sum, 41 - reduced), -STEEPEST_Q24, STEEPEST_Q24);
}

t3r_splat_surface t3r_splat_surface_of(const t3r_projection *projection, const t3r_gaussian *gaussian,
                                       const t3r_splat *splat)
{
    t3r_splat_surface surface = {.x_q12 = splat->x_q12, .y_q12 = splat->y_q12, .z_q20 = splat->z_q20};
    int32_t right_q12[3], down_q12[3], along_q24[3];
    if (!t3r_footprint_rows(projection, gaussian, right_q12, down_q12)) {
        return surface; /* only a splat that is not this Gaussian's */
    }
    depth_row(projection, gaussian, splat->z_q20, along_q24);
    const int64_t twice_q24 = 2 * (int64_t)t3r_isqrt64((uint64_t)dot(along_q24, along_q24)); /* below 2^30 */
    surface.most_q24 = (int32_t)((twice_q24 << 24) / ((1 << 24) + twice_q24));

    const int64_t x_q36 = dot(right_q12, along_q24), y_q36 = dot(down_q12, along_q24); /* at most 3 x 2^52 */
    const uint64_t most = (uint64_t)T3R_MAX(t3r_abs64(x_q36), t3r_abs64(y_q36)) | 1;
    const uint32_t reduced = (uint32_t)T3R_MAX((int32_t)t3r_msb64(most) - (PRODUCT_BITS - 1), 0);
    const int64_t x = t3r_round_shift64(x_q36, reduced), y = t3r_round_shift64(y_q36, reduced);
    surface.slope_q24[0] = slope_q24(splat->a_q30, x, splat->b_q30, y, reduced);
    surface.slope_q24[1] = slope_q24(splat->c_q30, y, splat->b_q30, x, reduced);
    return surface;
}

uint32_t t3r_surface_depth_q20(const t3r_splat_surface *surface, uint32_t x, uint32_t y)
{
    /* slopes are at most 2^28, offsets below 2^31: their products fit */
    const int64_t dx_q12 = ((int64_t)x << 12) - surface->x_q12, dy_q12 = ((int64_t)y << 12) - surface->y_q12;
    const int64_t change_q24 = t3r_round_shift64(surface->slope_q24[0] * dx_q12 + surface->slope_q24[1] * dy_q12, 12);
    const int64_t part_q24 = (1 << 24) - t3r_clamp64(change_q24, -surface->most_q24, surface->most_q24);
    return (uint32_t)T3R_MIN((((int64_t)surface->z_q20 << 24) + part_q24 / 2) / part_q24, (int64_t)INT32_MAX);
}
