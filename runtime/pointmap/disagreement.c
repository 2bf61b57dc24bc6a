#include "disagreement.h"

#include <stdbool.h>

#include "exposure.h"
#include "core/fixed.h"
#include "reproject.h"

/* Sum of at most 3 channels x 2^24 pixels x 16 views x 2 neighbours squares: below 2^24 x 2^31. */
typedef struct difference {
    uint64_t squares_q8;
    uint32_t pairs;
} difference;

static bool is_sure(uint8_t validity)
{
    return t3r_is_measured(validity) && !t3r_is_doubtful(validity);
}

static uint32_t squares_q8(const t3r_view *from, size_t pixel, const uint16_t from_gain_q14[3], const t3r_view *to,
                           size_t there, const uint16_t to_gain_q14[3])
{
    uint32_t sum = 0;
    for (int c = 0; c < 3; c++) {
        int32_t difference_q7 = t3r_level_q7(from->colour[c][pixel] * 128u, from_gain_q14[c]) -
                                t3r_level_q7(to->colour[c][there] * 128u, to_gain_q14[c]);
        int32_t difference_q4 = t3r_round_shift32(difference_q7, 3);
        sum += (uint32_t)(difference_q4 * difference_q4);
    }
    return sum;
}

static void compare(const t3r_view *views, uint32_t v, uint32_t w, int32_t exponent, uint16_t gain_q14[][3],
                    uint32_t step, difference *d)
{
    const t3r_view *view = &views[v], *other = &views[w];
    const t3r_pointmap from = t3r_pointmap_of(view, exponent), to = t3r_pointmap_of(other, exponent);
    for (uint32_t y = 0; y < view->height; y += step) {
        for (uint32_t x = 0; x < view->width; x += step) {
            size_t pixel = (size_t)y * view->width + x;
            t3r_projected_pixel projected;
            if (!is_sure(view->validity[pixel]) || !t3r_reproject(&from, x, y, &to, &projected) ||
                !is_sure(other->validity[projected.pixel])) {
                continue;
            }
            int32_t there_q20 = t3r_depth_q20(to.scale, other->depth[projected.pixel]);
            if (t3r_is_one_surface(projected.z_q20, there_q20, 32)) {
                d->squares_q8 += squares_q8(view, pixel, gain_q14[v], other, projected.pixel, gain_q14[w]);
                d->pairs++;
            }
        }
    }
}

uint32_t t3r_disagreement_q8(const t3r_view *views, uint32_t count, int32_t exponent, uint16_t gain_q14[][3],
                             uint32_t step, uint32_t *pairs)
{
    difference d = {0};
    for (uint32_t v = 0; v < count && count > 1; v++) {
        uint32_t next = (v + 1) % count;
        compare(views, v, next, exponent, gain_q14, step, &d);
        if (count > 2) { /* of two views, each is the other's next */
            compare(views, next, v, exponent, gain_q14, step, &d);
        }
    }
    *pairs = d.pairs;
    return d.pairs == 0 ? 0 : (uint32_t)t3r_round_div64((int64_t)d.squares_q8, 3 * (int64_t)d.pairs);
}
