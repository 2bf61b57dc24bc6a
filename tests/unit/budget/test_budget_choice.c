/* SPDX-License-Identifier: Apache-2.0 */
/* The budget for a bounded loss, from made-up evidence: equal to the formula in doubles, within its bounds at all
 * extremes. */
#include "unit/unit.h"

#include "loss/budget_choice.h"

static const t3r_budget_evidence plain = {
    .points = 100000,
    .trial = 1000,
    .error_q8 = {300 * 256, 200 * 256}, /* falls by 100 from 1000 to 2000: floor 100, slope 200,000 */
    .disagreement_q8 = 500 * 256,
};

/* slope / ((loss + 1/4) / 17 yardstick), rounded up */
TEST(as_in_double)
{
    assert_int_equal(t3r_predict_budget(&plain, 100000, 128), (uint32_t)ceil(200000 / (0.75 / 17 * 500)));
    uint64_t seed = 5;
    for (int turn = 0; turn < 20000; turn++) {
        t3r_budget_evidence e = {.points = (uint32_t)unit_between(&seed, 1000, 1 << 28)};
        e.trial = e.points / 100;
        int64_t range = unit_random(&seed) % 4 == 0 ? 4 * 256 : 1 << 24; /* often hardly any error */
        e.error_q8[1] = (uint32_t)unit_between(&seed, 0, range);
        e.error_q8[0] = (uint32_t)unit_between(&seed, e.error_q8[1], range);
        e.disagreement_q8 = unit_random(&seed) % 4 == 0 ? 0 : (uint32_t)unit_between(&seed, 1, 1 << 24);
        uint32_t loss_q8 = (uint32_t)unit_between(&seed, 1, T3R_MAX_LOSS_Q8);
        double fall = e.error_q8[0] - (double)e.error_q8[1], ground = fmax(0, e.error_q8[1] - fall);
        double yardstick = fmax(e.disagreement_q8 != 0 ? e.disagreement_q8 : ground, 2 * 256);
        double wanted = fall * 2 * e.trial / ((loss_q8 / 256.0 + 0.25) / 17 * yardstick);
        if (e.error_q8[1] < 2 * 256) {
            wanted = fmin(wanted, fall * 2 * e.trial / (2 * 256 - ground));
        }
        wanted = fmin(fmax(wanted, e.points / 400), e.points); /* in whole points */
        double got = t3r_predict_budget(&e, e.points, loss_q8);
        assert_true(got >= wanted * (1 - 1e-12) && got < wanted * (1 + 1e-12) + 1);
    }
}

TEST(more_loss_fewer_gaussians)
{
    uint32_t before = UINT32_MAX;
    for (uint32_t loss_q8 = 1; loss_q8 <= T3R_MAX_LOSS_Q8; loss_q8++) {
        uint32_t now = t3r_predict_budget(&plain, 100000, loss_q8);
        assert_true(now <= before && now >= 250);
        before = now;
    }
}

TEST(extremes)
{
    const uint32_t worst = 1 << 24, most_points = 1u << 28;
    t3r_budget_evidence e = {.points = most_points, .trial = most_points / 100, .error_q8 = {worst, 0}};
    assert_int_equal(t3r_predict_budget(&e, T3R_MAX_GAUSSIANS, 1), T3R_MAX_GAUSSIANS);
    e.error_q8[0] = 0; /* the error grows: more Gaussians gain nothing */
    e.error_q8[1] = worst;
    assert_int_equal(t3r_predict_budget(&e, T3R_MAX_GAUSSIANS, 1), most_points / 400);
    assert_int_equal(t3r_predict_budget(&e, 7, 1), 7);
    /* Just below 2 levels^2 the second trial's error is invisible, so that trial suffices; with 1/256 more it is
     * visible, and has to fall to the yardstick's share. */
    e = (t3r_budget_evidence){.points = 1000, .trial = 10, .error_q8 = {700, 511}, .disagreement_q8 = 1024};
    assert_int_equal(t3r_predict_budget(&e, 1000, 1), 20);
    e.error_q8[0]++;
    e.error_q8[1]++;
    assert_int_equal(t3r_predict_budget(&e, 1000, 1), 248);
    e = (t3r_budget_evidence){.points = 2, .trial = 1};
    assert_int_equal(t3r_predict_budget(&e, 2, T3R_MAX_LOSS_Q8), 1);
}
