/* SPDX-License-Identifier: Apache-2.0 */
#include "backdrop.h"

#include "core/fixed.h"
#include "head.h"
#include "pointmap/exposure.h"
#include "pointmap/pointmap.h"
#include "rim.h"

#define SAMPLES 16u                                                          /* of each side of a view */
#define OPACITY_Q15 32440                                                    /* 0.99 */
#define WIDTH_Q24(n) (((int64_t)T3R_BACKDROP_DISTANCE_Q20 << 6) / (3 * (n))) /* 4/3 of a spacing */

/* A colour, as a weighted sum over samples of the borders. Weights are at most 2^14 + 1 and colours 2^15, so that the
 * 2^10 samples of 16 views stay below 2^40. */
typedef struct mean_colour {
    uint64_t weight, colour[3];
} mean_colour;

/* Adds a pixel by how near its ray is to the direction, whose length is in Q8: weight ((1 + cos) / 2)^8. */
static void add_pixel(mean_colour *mean, const t3r_pointmap *map, const uint16_t gain_q14[3], uint32_t u, uint32_t v,
                      const int32_t direction[3], int64_t length_q8)
{
    const t3r_view *view = map->view;
    int32_t ray_q24[2];
    t3r_ray_q24(map, u, v, ray_q24);
    int64_t along = 0; /* Q24, below 3 x 2^33 */
    for (int i = 0; i < 3; i++) {
        const int32_t *r_q30 = view->pose.rotation_q30 + 3 * i;
        const int64_t sum =
            (int64_t)r_q30[0] * ray_q24[0] + (int64_t)r_q30[1] * ray_q24[1] + (int64_t)r_q30[2] * (1 << 24);
        along += t3r_round_shift64(sum, 30) * direction[i];
    }
    const int64_t square = (int64_t)ray_q24[0] * ray_q24[0] + (int64_t)ray_q24[1] * ray_q24[1] + (INT64_C(1) << 48);
    const int64_t lengths_q24 = (int64_t)t3r_isqrt64((uint64_t)square) * length_q8 >> 8;
    const int64_t cosine_q14 = t3r_clamp64(along * (1 << 14) / lengths_q24, -(1 << 14), 1 << 14);
    uint32_t near_q14 = (uint32_t)((1 << 14) + cosine_q14) >> 1;
    for (int power = 1; power < 8; power *= 2) {
        near_q14 = near_q14 * near_q14 >> 14;
    }
    const size_t pixel = (size_t)v * view->width + u;
    mean->weight += near_q14 + 1;
    for (int c = 0; c < 3; c++) {
        mean->colour[c] += (uint64_t)(near_q14 + 1) * t3r_level_q7(128u * view->colour[c][pixel], gain_q14[c]);
    }
}

/* Adds the pixels along the border of a view. */
static void add_border(mean_colour *mean, const t3r_pointmap *map, const uint16_t gain_q14[3],
                       const int32_t direction[3], int64_t length_q8)
{
    const uint32_t right = map->view->width - 1, bottom = map->view->height - 1;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        const uint32_t u = (2 * i + 1) * map->view->width / (2 * SAMPLES);
        const uint32_t v = (2 * i + 1) * map->view->height / (2 * SAMPLES);
        add_pixel(mean, map, gain_q14, u, 0, direction, length_q8);
        add_pixel(mean, map, gain_q14, u, bottom, direction, length_q8);
        add_pixel(mean, map, gain_q14, 0, v, direction, length_q8);
        add_pixel(mean, map, gain_q14, right, v, direction, length_q8);
    }
}

/* Makes the Gaussian of a direction. */
static void make(const t3r_runtime *rt, const t3r_pointmap maps[T3R_MAX_VIEWS], const int32_t direction[3], uint32_t n,
                 t3r_gaussian *out)
{
    const int64_t square =
        direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]; /* at most 17 */
    const int64_t length_q8 = t3r_isqrt64((uint64_t)square << 16);
    mean_colour mean = {0};
    for (uint32_t v = 0; v < rt->views; v++) {
        add_border(&mean, &maps[v], rt->gain_q14[v], direction, length_q8);
    }
    T3R_BOUND(mean.weight > 0); /* each border weighs at least 1 */
    const int64_t width = WIDTH_Q24(n), entry[9] = {width, 0, 0, 0, width, 0, 0, 0, width};
    *out = (t3r_gaussian){.view = T3R_NO_VIEW, .opacity_q15 = OPACITY_Q15};
    t3r_pack_factor(entry, 24, out);
    for (int i = 0; i < 3; i++) {
        out->position_q20[i] = (int32_t)(direction[i] * (INT64_C(1) << 8) * T3R_BACKDROP_DISTANCE_Q20 / length_q8);
        out->colour_q7[i] = (uint16_t)((mean.colour[i] + mean.weight / 2) / mean.weight);
    }
}

uint32_t t3r_backdrop_count(const t3r_runtime *rt, const t3r_view *views)
{
    const uint32_t n = t3r_backdrop_side(&rt->config, t3r_gaussians_of(rt));
    return 6 * n * n + t3r_make_rim(rt, views, NULL);
}

void t3r_add_backdrop(t3r_runtime *rt, const t3r_view *views)
{
    const int32_t n = (int32_t)t3r_backdrop_side(&rt->config, t3r_gaussians_of(rt));
    t3r_gaussian *scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    t3r_pointmap maps[T3R_MAX_VIEWS];
    t3r_pointmaps_of(views, rt->views, rt->frame.exponent, maps);
    rt->gaussians += t3r_make_rim(rt, views, scene + rt->gaussians);
    for (int32_t face = 0; face < 6 && n > 0; face++) {
        const int32_t axis = face / 2;
        for (int32_t cell = 0; cell < n * n; cell++) {
            int32_t direction[3];
            direction[axis] = face % 2 == 0 ? n : -n;
            direction[(axis + 1) % 3] = 2 * (cell % n) - n + 1;
            direction[(axis + 2) % 3] = 2 * (cell / n) - n + 1;
            make(rt, maps, direction, (uint32_t)n, &scene[rt->gaussians++]);
        }
    }
}
