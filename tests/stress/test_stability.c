/* SPDX-License-Identifier: Apache-2.0 */
/* Cells of a small scene: measurements must agree with known values. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plane.h"
#include "study/stress/stability.h"
#include "study/stress/table.h"
#include "test.h"

static int open_plane(void **state)
{
    return plane_open(state, (stress_contest){.methods = {&method_trim3r, RIVAL_METHOD(METHOD_RANDOM, METHOD_PLAIN),
                                                          RIVAL_METHOD(METHOD_EAGLES, METHOD_PLAIN)},
                                              .method_count = METHODS,
                                              .captures = 3});
}

static void cell(plane *f, const char *name, uint32_t grade)
{
    const perturbation *p = NULL;
    for (uint32_t i = 0; name != NULL && (p = stress_perturbation(i)) != NULL && strcmp(p->name, name) != 0; i++) {
    }
    assert_int_equal(stress_measure(f->rows, f->renders, &f->c, &f->contest, p, grade), 0);
}

/* The noise of a still scene moves a Gaussian without refinement or network along its ray: depth noise of 0.2 % in both
 * captures, 0.954 deviations apart in the median; a rival's mask of random scores stays, as the same pixels have depth.
 */
TEST_WITH(still_scene, open_plane, plane_close)
{
    plane *f = *state;
    cell(f, NULL, 0);
    for (int m = 0; m < METHODS; m++) {
        const stress_row *row = &f->rows[m];
        assert_int_equal(row->status, STRESS_MEASURED);
        assert_int_equal((int)row->value[STRESS_GAUSSIANS], (2 * SIDE * SIDE + 2) / 5);
        double spacing = sqrt(2.0 * SIDE * SIDE / row->value[STRESS_GAUSSIANS]); /* pixels */
        double expected = 0.002 * 0.954 * SIDE * 0.866 / spacing;                /* distance cancels */
        assert_true(fabs(stress_still_motion(&f->c.base, row->value[STRESS_GAUSSIANS]) / expected - 1) < 0.01);
        /* a median of 900 has a deviation of 4 %; for eagles, Gaussians that stay in both captures are a biased sample
         */
        if (m != 2 && fabs(row->value[STRESS_MOTION] / expected - 1) > 0.12) {
            fail_msg("motion %g, not %g", row->value[STRESS_MOTION], expected);
        }
        assert_true(row->value[STRESS_FLICKER] > 0.1 && row->value[STRESS_FLICKER] < 60);
        assert_true(row->value[STRESS_FLICKER_UNPRUNED] > 0.1 && row->value[STRESS_FLICKER_UNPRUNED] < 6);
    }
    assert_true(f->rows[1].value[STRESS_MASK_CHANGED] <= 0);
    assert_true(f->rows[0].value[STRESS_MASK_CHANGED] < 0.25);
    assert_true(f->rows[2].value[STRESS_MASK_CHANGED] > f->rows[0].value[STRESS_MASK_CHANGED]);
}

/* Checks the invariant where it can fail: the shipped head and refinement on every drawn scene, from as many Gaussians
 * as SuperClusters up. An unchanged mask would mean that nothing was captured again. */
TEST_WITH(learned_and_refined, open_plane, plane_close)
{
    plane *f = *state;
    const double keeps[] = {2, 40};
    reconstruction_defaults(&f->contest.settings);
    f->contest.settings.config.width = f->contest.settings.config.height = SIDE;
    f->contest.settings.config.clusters = 80;
    f->contest.method_count = 1;
    assert_true(f->contest.settings.config.refine > 0 && strcmp(f->contest.settings.head, "analytic") != 0);
    const stress_scene *scene;
    for (uint32_t i = 0; (scene = stress_scene_at(i)) != NULL; i++) {
        stress_case c = {.name = scene->name, .context = "0,1", .target = "2"};
        assert_true(stress_scene_draw(&c.base, scene, scene->strength[1], SIDE, SIDE));
        for (uint32_t k = 0; k < 2; k++) {
            f->contest.keep[0] = keeps[k];
            assert_int_equal(stress_case_open(&c, &f->contest), 0);
            assert_int_equal(stress_measure(f->rows, f->renders, &c, &f->contest, NULL, 0), 0);
            stress_case_close(&c);
            const double *value = f->rows[0].value;
            double noise = stress_still_motion(&c.base, value[STRESS_GAUSSIANS]);
            if (f->rows[0].status != STRESS_MEASURED) {
                fail_msg("%s at %g %%: %s", scene->name, keeps[k], f->rows[0].reason);
            }
            assert_true(value[STRESS_GAUSSIANS] >= f->contest.settings.config.clusters);
            assert_true(value[STRESS_MASK_CHANGED] > 0 && value[STRESS_MOTION] > 0);
            /* the bounds are within reach */
            assert_true(stress_mask_changed_most(value[STRESS_GAUSSIANS], 80) < 8 * value[STRESS_MASK_CHANGED]);
            assert_true(stress_motion_most(noise) < 12 * value[STRESS_MOTION]);
        }
        stress_capture_free(&c.base);
    }
}

/* A moved world gives the same scene; a budget above the remaining points takes all of them; without points it is
 * refused. */
TEST_WITH(budgets_and_refusals, open_plane, plane_close)
{
    plane *f = *state;
    stress_row plain[METHODS];
    f->contest.captures = 0;
    cell(f, NULL, 0);
    memcpy(plain, f->rows, sizeof plain);
    cell(f, "huge", 2);
    stress_relate(f->rows, plain, METHODS, false);
    for (int m = 0; m < METHODS; m++) {
        assert_int_equal(f->rows[m].status, STRESS_MEASURED);
        assert_true(fabs(f->rows[m].value[STRESS_PSNR_LOST]) < 0.01);
        assert_true(f->rows[m].value[STRESS_ARENA_BYTES] <= plain[m].value[STRESS_ARENA_BYTES]);
        assert_true(isnan(f->rows[m].value[STRESS_FLICKER]) && isnan(f->rows[m].value[STRESS_MOTION]));
    }
    cell(f, "depth-all", 1);
    for (int m = 0; m < METHODS; m++) {
        assert_int_equal(f->rows[m].status, STRESS_MEASURED);
        assert_true(f->rows[m].value[STRESS_GAUSSIANS] < 100 && f->rows[m].value[STRESS_GAUSSIANS] > 10);
        assert_true(f->rows[m].value[STRESS_BUDGET] > 900);
    }
    cell(f, "depth-all", 3);
    for (int m = 0; m < METHODS; m++) {
        assert_int_equal(f->rows[m].status, STRESS_REFUSED);
        assert_non_null(strstr(f->rows[m].reason, "no valid depth"));
        assert_true(isnan(f->rows[m].value[STRESS_PSNR]));
    }
}

TEST(means_of_rows)
{
    stress_row rows[3] = {{.what = "noise", .grade = 1, .keep = 10},
                          {.what = "noise", .grade = 1, .keep = 10},
                          {.what = "noise", .grade = 2, .keep = 10}};
    rows[0].value[STRESS_PSNR_LOST] = 3;
    rows[1].value[STRESS_PSNR_LOST] = NAN;
    rows[1].status = STRESS_REFUSED;
    rows[2].value[STRESS_PSNR_LOST] = 9;
    uint32_t refused;
    assert_true(fabs(stress_mean(rows, 3, &rows[0], STRESS_PSNR_LOST, &refused) - 3) < 1e-9);
    assert_int_equal(refused, 1);
    rows[0].keep = 20;
    assert_true(isnan(stress_mean(rows, 3, &rows[1], STRESS_PSNR_LOST, NULL)));
}
