/* SPDX-License-Identifier: Apache-2.0 */
#include "disagreement.h"

#include <stdbool.h>

#include "core/fixed.h"
#include "exposure.h"
#include "reproject.h"

/* Sums over at most 2^24 pixels x 16 views x 2 neighbours, of three channels: below 2^31 x 2^24. */
typedef struct difference {
    uint64_t squares_q8;
    int64_t products_q8; /* of pairs and the pairs to their right */
    uint32_t pairs, beside;
} difference;

/* A view in a comparison. */
typedef struct compared_view {
    t3r_pointmap map;
    const uint16_t *gain_q14;
} compared_view;

static bool is_sure(uint8_t validity)
{
    return t3r_is_measured(validity) && !t3r_is_doubtful(validity);
}

/* Computes by how much the colours of pixel (x, y) differ from those of the pixel that it falls on. Returns false if
 * the two are no pair. */
static bool differ(const compared_view *from, uint32_t x, uint32_t y, const compared_view *to, int32_t by_q4[3])
{
    const t3r_view *view = from->map.view, *other = to->map.view;
    const size_t pixel = (size_t)y * view->width + x;
    t3r_projected_pixel there;
    if (!is_sure(view->validity[pixel]) || !t3r_reproject(&from->map, x, y, &to->map, &there) ||
        !is_sure(other->validity[there.pixel]) ||
        !t3r_is_one_surface(there.z_q20, t3r_depth_q20(to->map.scale, other->depth[there.pixel]), 32)) {
        return false;
    }
    for (int c = 0; c < 3; c++) {
        int32_t difference_q7 = t3r_level_q7(view->colour[c][pixel] * 128u, from->gain_q14[c]) -
                                t3r_level_q7(other->colour[c][there.pixel] * 128u, to->gain_q14[c]);
        by_q4[c] = t3r_round_shift32(difference_q7, 3);
    }
    return true;
}

/* The differences are below 2^12. */
static int32_t product_q8(const int32_t a_q4[3], const int32_t b_q4[3])
{
    return a_q4[0] * b_q4[0] + a_q4[1] * b_q4[1] + a_q4[2] * b_q4[2];
}

static void compare(const compared_view *from, const compared_view *to, uint32_t step, bool neighbours, difference *d)
{
    const t3r_view *view = from->map.view;
    for (uint32_t y = 0; y < view->height; y += step) {
        for (uint32_t x = 0; x < view->width; x += step) {
            int32_t here_q4[3], beside_q4[3];
            if (!differ(from, x, y, to, here_q4)) {
                continue;
            }
            d->squares_q8 += (uint32_t)product_q8(here_q4, here_q4);
            d->pairs++;
            if (neighbours && x + 1 < view->width && differ(from, x + 1, y, to, beside_q4)) {
                d->products_q8 += product_q8(here_q4, beside_q4);
                d->beside++;
            }
        }
    }
}

uint32_t t3r_disagreement_q8(const t3r_view *views, uint32_t count, int32_t exponent, uint16_t gain_q14[][3],
                             uint32_t step, uint32_t *pairs, int32_t *shared_q8)
{
    difference d = {0};
    for (uint32_t v = 0; v < count && count > 1; v++) {
        const uint32_t w = (v + 1) % count;
        const compared_view view = {t3r_pointmap_of(&views[v], exponent), gain_q14[v]};
        const compared_view next = {t3r_pointmap_of(&views[w], exponent), gain_q14[w]};
        compare(&view, &next, step, shared_q8 != NULL, &d);
        if (count > 2) { /* of two views, each is the other's next */
            compare(&next, &view, step, shared_q8 != NULL, &d);
        }
    }
    *pairs = d.pairs;
    if (shared_q8 != NULL) {
        *shared_q8 = d.beside == 0 ? 0 : (int32_t)t3r_round_div64(d.products_q8, 3 * (int64_t)d.beside);
    }
    return d.pairs == 0 ? 0 : (uint32_t)t3r_round_div64((int64_t)d.squares_q8, 3 * (int64_t)d.pairs);
}
