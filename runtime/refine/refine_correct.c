/* SPDX-License-Identifier: Apache-2.0 */
/* Applies a correction to a Gaussian (SPEC.md, "Refinement"). */
#include "core/fixed.h"
#include "core/scene_frame.h"
#include "head/head.h"
#include "refine.h"

#define OPACITY_LEAST_Q15 256
#define OPACITY_MOST_Q15 32440 /* 0.99: the most that the rasterizer draws */
#define REACH 8                /* parts of the distance to a camera */

static void apply_opacity(int32_t step_q16, t3r_gaussian *g)
{
    if (step_q16 == 0) {
        return;
    }
    int32_t log_q16 = (int32_t)t3r_round_shift64((int64_t)step_q16 * 94548, 16); /* log2 e in Q16 */
    int64_t opacity = t3r_round_shift64((int64_t)g->opacity_q15 * t3r_exp2_q16(log_q16), 16);
    int64_t least = T3R_MIN(g->opacity_q15, OPACITY_LEAST_Q15), most = T3R_MAX(g->opacity_q15, OPACITY_MOST_Q15);
    g->opacity_q15 = (uint16_t)t3r_clamp64(opacity, least, most);
}

/* Returns the most that a centre moves along an axis: a part of its distance to the nearest camera, Q20. The distance
 * is that along the axis where the two are farthest apart. */
static int64_t reach_q20(const t3r_viewpoints *from, const t3r_gaussian *g)
{
    int64_t nearest = 2 * (int64_t)T3R_POSITION_MOST_Q20;
    for (uint32_t v = 0; v < from->count; v++) {
        int64_t distance = 0;
        for (int i = 0; i < 3; i++) {
            distance = T3R_MAX(distance, t3r_abs64((int64_t)g->position_q20[i] - from->position_q20[v][i]));
        }
        nearest = T3R_MIN(nearest, distance);
    }
    return T3R_MAX(nearest / REACH, 1);
}

/* Adds F (x, y, 0) to the position. A long Gaussian that is seen along its length could move through a camera, and
 * cover its picture; so it moves by less than its reach. */
static void apply_shift(const int16_t step_q16[2], const t3r_viewpoints *from, t3r_gaussian *g)
{
    int64_t moved_q20[3], most = 0;
    for (int i = 0; i < 3; i++) {
        /* 2 x 2^15 x 2^14, times at most 2^19 */
        const int64_t moved = (int64_t)g->factor[3 * i] * step_q16[0] + (int64_t)g->factor[3 * i + 1] * step_q16[1];
        moved_q20[i] = t3r_scale64(moved, g->factor_exponent + 20 - 16);
        most = T3R_MAX(most, t3r_abs64(moved_q20[i]));
    }
    const int64_t reach = reach_q20(from, g), part = most > reach ? most / reach + 1 : 1;
    for (int i = 0; i < 3; i++) {
        const int64_t x = g->position_q20[i] + moved_q20[i] / part;
        g->position_q20[i] = (int32_t)t3r_clamp64(x, -T3R_POSITION_MOST_Q20, T3R_POSITION_MOST_Q20);
    }
}

/* Multiplies F by I + s, s = (xx xy 0; xy yy 0; 0 0 0). */
static void apply_shape(const int16_t step_q16[3], t3r_gaussian *g)
{
    if (step_q16[0] == 0 && step_q16[1] == 0 && step_q16[2] == 0) {
        return;
    }
    int64_t entry[9];
    for (int i = 0; i < 9; i += 3) {
        int64_t a = g->factor[i], b = g->factor[i + 1];
        entry[i] = a * ((1 << 16) + step_q16[0]) + b * step_q16[1];
        entry[i + 1] = a * step_q16[1] + b * ((1 << 16) + step_q16[2]);
        entry[i + 2] = (int64_t)g->factor[i + 2] * (1 << 16);
    }
    if (g->factor_exponent <= 13 && g->factor_exponent >= -47) { /* the new exponent fits */
        t3r_pack_factor(entry, 16 - g->factor_exponent, g);
    }
}

void t3r_refine_apply_colour(const t3r_correction *c, t3r_gaussian *g)
{
    for (int i = 0; i < 3; i++) {
        g->colour_q7[i] = (uint16_t)t3r_clamp32(g->colour_q7[i] + c->colour_q7[i], 0, 255 * 128);
    }
}

void t3r_refine_apply(const t3r_correction *c, const t3r_viewpoints *from, t3r_gaussian *g)
{
    t3r_refine_apply_colour(c, g);
    apply_opacity(c->step_q16[0], g);
    apply_shift(c->step_q16 + 1, from, g);
    apply_shape(c->step_q16 + 3, g);
}
