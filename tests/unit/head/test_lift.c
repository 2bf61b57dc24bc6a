/* SPDX-License-Identifier: Apache-2.0 */
/* Footprints to Gaussians: narrower than the least width, and without width. */
#include "unit/rig.h"

#include "head/head.h"

/* Lifts a footprint of that many square pixels (Q12) in the middle of a parallel plane at `steps` of 2^-20 scene
 * units. */
static t3r_gaussian lifted_as(uint16_t steps, int32_t square_q12, uint32_t narrowest_q12)
{
    rig *s = unit_array(1, sizeof *s);
    t3r_gaussian g;
    const t3r_footprint f = {
        .xx_q12 = square_q12, .yy_q12 = square_q12, .colour_q7 = {1, 2, 3}, .opacity_q15 = T3R_HEAD_OPACITY_Q15};
    place_view_in_steps(s, 0, 0, 0, ldexp(steps, -20), UINT64_C(1) << 20);
    const t3r_head_input input = {.map = t3r_pointmap_of(&s->view[0], 0), .narrowest_q12 = narrowest_q12};
    memset(&g, 0xa5, sizeof g);
    t3r_lift(&input, W / 2, H / 2, &f, &g);
    assert_int_equal(g.position_q20[2], steps);
    assert_true(g.colour_q7[0] == 1 && g.colour_q7[2] == 3 && g.opacity_q15 == T3R_HEAD_OPACITY_Q15);
    free(s);
    return g;
}

static t3r_gaussian lifted(uint16_t steps)
{
    return lifted_as(steps, 17613, T3R_NARROWEST_Q12);
}

/* A standard deviation of two pixels, an eighth of it thick: exact to steps of 2^-24 scene units. */
TEST(as_wide_as_its_pixels)
{
    static const uint16_t depths[] = {64, 1000, 20000, 65535};
    for (size_t i = 0; i < sizeof depths / sizeof depths[0]; i++) {
        const t3r_gaussian g = lifted(depths[i]);
        const double wide = 2 * ldexp(depths[i], -20) / F, step = ldexp(1, -23);
        for (int k = 0; k < 9; k++) {
            const double want = k == 0 || k == 4 ? wide : k == 8 ? wide / 8 : 0;
            assert_true(fabs(fabs(ldexp(g.factor[k], g.factor_exponent)) - want) < 0.01 * want + step);
        }
    }
}

/* The footprint minus the rasterizer's 0.3 square pixels is at least the narrowest. */
TEST(no_narrower_than_allowed)
{
    static const struct {
        int32_t square_q12;
        uint32_t narrowest_q12, left_q12;
    } cases[] = {{1000, T3R_NARROWEST_Q12, T3R_NARROWEST_Q12},
                 {1000, T3R_NARROWEST_REFINED_Q12, T3R_NARROWEST_REFINED_Q12},
                 {1229 + 400, T3R_NARROWEST_Q12, 400},
                 {1229 + 400, T3R_NARROWEST_REFINED_Q12, T3R_NARROWEST_REFINED_Q12},
                 {1229 + 900, T3R_NARROWEST_REFINED_Q12, 900}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const t3r_gaussian g = lifted_as(20000, cases[i].square_q12, cases[i].narrowest_q12);
        const double wide = sqrt(cases[i].left_q12 / 4096.0) * ldexp(20000, -20) / F;
        assert_true(fabs(fabs(ldexp(g.factor[0], g.factor_exponent)) - wide) < 0.01 * wide);
        assert_true(fabs(fabs(ldexp(g.factor[4], g.factor_exponent)) - wide) < 0.01 * wide);
    }
}

/* One step from the camera a pixel is narrower than half a step: the Gaussian has no extent. */
TEST(of_no_extent)
{
    const t3r_gaussian g = lifted(1);
    for (int k = 0; k < 9; k++) {
        assert_int_equal(g.factor[k], 0);
    }
}
