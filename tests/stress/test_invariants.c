/* SPDX-License-Identifier: Apache-2.0 */
/* Every invariant, broken on purpose: it must be reported, and `trim3r stress` must exit with status 1. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plane.h"
#include "study/stress/invariant.h"
#include "study/stress/random.h"
#include "study/stress/report.h"
#include "study/stress/stability.h"
#include "study/stress/verdict.h"
#include "test.h"

/* ---- a scene ----------------------------------------------------------------------------------------------------- */

TEST(scenes_out_of_bounds)
{
    t3r_gaussian g[2] = {{.factor = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .opacity_q15 = 32767}, {.factor = {0}}};
    t3r_scene scene = {.gaussians = g, .count = 2};
    assert_null(stress_broken_invariant(&scene, 2, false));
    assert_string_equal(stress_broken_invariant(&scene, 3, false), "the budget is not met");
    assert_null(stress_broken_invariant(&scene, 3, true));
    assert_string_equal(stress_broken_invariant(&scene, 1, true), "the budget is not met");
    g[1].position_q20[2] = (1 << 30) + 1;
    assert_string_equal(stress_broken_invariant(&scene, 2, false), "a Gaussian is out of range");
    g[1].position_q20[2] = 0;
    g[0].opacity_q15 = 32768;
    assert_string_equal(stress_broken_invariant(&scene, 2, false), "a Gaussian is out of range");
    g[0].opacity_q15 = 0;
    g[0].factor_exponent = 16;
    assert_string_equal(stress_broken_invariant(&scene, 2, false), "a Gaussian is out of range");
}

/* The extremes that in_range accepts are finite; anything that is not is reported. */
TEST(shapes_that_no_file_holds)
{
    static const int16_t entries[] = {0, 1, -1, INT16_MAX, INT16_MIN};
    enum { ENTRIES = sizeof entries / sizeof *entries };
    for (int exponent = -60; exponent <= 15; exponent += 75) {
        for (uint32_t drawn = 0; drawn < 5000; drawn++) {
            t3r_gaussian g = {.factor_exponent = (int8_t)exponent};
            for (uint32_t i = 0; i < 9; i++) {
                g.factor[i] = entries[stress_random(drawn, i) % ENTRIES];
            }
            gaussian_shape shape = gaussian_shape_of(&g);
            assert_true(stress_finite(&shape));
        }
    }
    const gaussian_shape sound = {.scale = {1, 2, 3}, .rotation = {1, 0, 0, 0}};
    assert_true(stress_finite(&sound));
    for (int i = 0; i < 3; i++) {
        gaussian_shape shape = sound;
        shape.scale[i] = 0;
        assert_false(stress_finite(&shape));
        shape.scale[i] = NAN;
        assert_false(stress_finite(&shape));
    }
    for (int i = 0; i < 4; i++) {
        gaussian_shape shape = sound;
        shape.rotation[i] = INFINITY;
        assert_false(stress_finite(&shape));
        shape.rotation[i] = NAN;
        assert_false(stress_finite(&shape));
    }
}

/* ---- a cell ------------------------------------------------------------------------------------------------------ */

static int open_plane(void **state)
{
    return plane_open(state, (stress_contest){.methods = {&method_trim3r}, .method_count = 1});
}

static void cell(plane *f, const perturbation *p)
{
    assert_int_equal(stress_measure(f->rows, f->renders, &f->c, &f->contest, p, p == NULL ? 0 : 1), CLI_OK);
}

/* A target without pixels that count has no score. */
TEST_WITH(scores_that_are_no_numbers, open_plane, plane_close)
{
    plane *f = *state;
    cell(f, NULL);
    assert_int_equal(f->rows[0].status, STRESS_MEASURED);
    memset(f->c.views.target.mask, 0, (size_t)SIDE * SIDE);
    cell(f, NULL);
    assert_int_equal(f->rows[0].status, STRESS_BROKEN);
    assert_string_equal(f->rows[0].reason, "the render has no finite score");
}

/* For unperturbed frames, a too small arena is a refusal: nothing guarantees that it suffices. If it sufficed for
 * those, it must suffice for perturbed ones. */
TEST_WITH(arenas_too_small_for_perturbed_frames, open_plane, plane_close)
{
    plane *f = *state;
    const perturbation *noise = stress_perturbation(0);
    cell(f, noise);
    assert_int_equal(f->rows[0].status, STRESS_MEASURED);
    f->contest.settings.arena = ARENA_BYTES;
    f->contest.settings.arena_bytes = 1000;
    cell(f, NULL);
    assert_int_equal(f->rows[0].status, STRESS_REFUSED);
    cell(f, noise);
    assert_int_equal(f->rows[0].status, STRESS_BROKEN);
    assert_non_null(strstr(f->rows[0].reason, "too small"));
}

/* ---- rows -------------------------------------------------------------------------------------------------------- */

/* An arena that grew, or changed for the same budget, is reported; a rival's arena is that of all points. */
TEST(arenas_that_change)
{
    stress_row base = {.method = &method_trim3r}, row;
    base.value[STRESS_ARENA_BYTES] = base.value[STRESS_GAUSSIANS] = 1000;
    const struct {
        const method *method;
        double arena, gaussians;
        stress_status expected;
    } cases[] = {{&method_trim3r, 1000, 1000, STRESS_MEASURED},
                 {&method_trim3r, 1001, 1000, STRESS_BROKEN},
                 {&method_trim3r, 999, 1000, STRESS_BROKEN},
                 {&method_trim3r, 999, 500, STRESS_MEASURED},
                 {RIVAL_METHOD(METHOD_EAGLES, METHOD_PLAIN), 999, 1000, STRESS_MEASURED},
                 {RIVAL_METHOD(METHOD_EAGLES, METHOD_PLAIN), 1001, 1000, STRESS_MEASURED}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        row = base;
        row.method = cases[i].method;
        row.value[STRESS_ARENA_BYTES] = cases[i].arena;
        row.value[STRESS_GAUSSIANS] = cases[i].gaussians;
        const stress_row before = row;
        stress_relate(&row, &base, 1, false);
        assert_int_equal(row.status, cases[i].expected);
        row = before;
        stress_relate(&row, &base, 1, true);
        assert_int_equal(row.status, STRESS_MEASURED);
    }
}

static stress_row still_row(double gaussians, double changed, double motion)
{
    stress_row row = {.what = STRESS_UNPERTURBED, .unit = "", .method = &method_trim3r, .keep = 10};
    snprintf(row.scene, sizeof row.scene, "room");
    row.value[STRESS_GAUSSIANS] = gaussians;
    row.value[STRESS_MASK_CHANGED] = changed;
    row.value[STRESS_MOTION] = motion;
    return row;
}

/* Bounds: at 1, 4 and 100 Gaussians a SuperCluster, just within and just beyond. */
TEST(still_scenes_that_do_not_stay)
{
    const double noise = 0.125;
    const struct {
        const method *method;
        double gaussians, changed, motion;
        stress_status expected;
    } cases[] = {{&method_trim3r, 300, 0.5, 0, STRESS_MEASURED},
                 {&method_trim3r, 300, 0.51, 0, STRESS_BROKEN},
                 {&method_trim3r, 1200, 0.299, 0, STRESS_MEASURED},
                 {&method_trim3r, 1200, 0.301, 0, STRESS_BROKEN},
                 {&method_trim3r, 30000, 0.0599, 0, STRESS_MEASURED},
                 {&method_trim3r, 30000, 0.0601, 0, STRESS_BROKEN},
                 {&method_trim3r, 30000, 0, 0.874, STRESS_MEASURED},
                 {&method_trim3r, 30000, 0, 0.876, STRESS_BROKEN},
                 {&method_trim3r, 299, 1, 1, STRESS_MEASURED},
                 {&method_trim3r, 30000, NAN, 0, STRESS_BROKEN},
                 {&method_trim3r, 30000, 0, INFINITY, STRESS_BROKEN},
                 {RIVAL_METHOD(METHOD_EAGLES, METHOD_PLAIN), 30000, 1, 1, STRESS_MEASURED}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        stress_row row = still_row(cases[i].gaussians, cases[i].changed, cases[i].motion);
        row.method = cases[i].method;
        stress_judge_still(&row, 300, noise);
        assert_int_equal(row.status, cases[i].expected);
        assert_int_equal(strncmp(row.reason, "a still scene does not stay", 27) == 0, row.status == STRESS_BROKEN);
    }
}

/* The report of a broken invariant: a line, its cell and reason, and the exit status. */
TEST(exit_status_of_a_broken_invariant)
{
    const stress_contest contest = {.methods = {&method_trim3r}, .method_count = 1, .keep = {10}, .keep_count = 1};
    const stress_outputs to = {.worst = 1};
    stress_row row = still_row(1000, 0, 0);
    stress_report report;
    assert_int_equal(stress_report_open(&report, &to, &contest, 1), CLI_OK);
    assert_int_equal(stress_report_cell(&report, &row, NULL, NULL, NULL, NULL), CLI_OK);
    assert_int_equal(stress_report_close(&report, CLI_OK), CLI_OK);

    row.status = STRESS_REFUSED; /* is a result */
    assert_int_equal(stress_report_open(&report, &to, &contest, 1), CLI_OK);
    assert_int_equal(stress_report_cell(&report, &row, NULL, NULL, NULL, NULL), CLI_OK);
    assert_int_equal(stress_report_close(&report, CLI_OK), CLI_OK);

    row.status = STRESS_BROKEN;
    snprintf(row.reason, sizeof row.reason, "the budget is not met");
    assert_int_equal(stress_report_open(&report, &to, &contest, 1), CLI_OK);
    assert_int_equal(stress_report_cell(&report, &row, NULL, NULL, NULL, NULL), CLI_OK);
    assert_int_equal(stress_report_close(&report, CLI_OK), CLI_BAD_INPUT);

    char *told = NULL;
    size_t bytes = 0;
    FILE *out = open_memstream(&told, &bytes);
    assert_non_null(out);
    stress_print_verdict(out, &row, 1, &contest);
    assert_int_equal(fclose(out), 0);
    assert_non_null(strstr(told, "BROKEN  room: unperturbed, trim3r at 10 %: the budget is not met\n"));
    assert_non_null(strstr(told, "1 rows: 0 measured, 0 refused with a reason, 1 with a broken invariant"));
    free(told);
}
