/* SPDX-License-Identifier: Apache-2.0 */
/* Rounds of pruning: their counts, and a model that is pruned and fine-tuned in several. */
#include "splat_scenes.h"
#include "study/rivals/scores/score.h"
#include "study/rivals/tuning/rounds.h"
#include "study/rivals/tuning/tune.h"
#include "test.h"

enum { SIDE = 32, COUNT = 200, BUDGET = 25 };

TEST(counts)
{
    for (method_kind kind = METHOD_RANDOM; kind < METHOD_KIND_COUNT; kind++) {
        for (uint32_t rounds = 1; rounds <= ROUNDS_MOST; rounds++) {
            uint32_t before = 1000, iterations = 0;
            for (uint32_t round = 0; round < rounds; round++) {
                uint32_t left = rounds_left(kind, 1000, 17, round, rounds);
                assert_true(left <= before && left >= 17);
                before = left;
                iterations += rounds_iterations(203, round, rounds);
            }
            assert_true(before == 17 && iterations == 203);
            assert_true(rounds_left(kind, 9, 10, 0, rounds) == 10); /* nothing to prune */
        }
    }
    assert_true(rounds_published(METHOD_PUP) == 2 && rounds_published(METHOD_RANDOM) == 1);
    /* as published: 80 %, then half of the rest */
    assert_true(rounds_left(METHOD_PUP, 1000, 100, 0, 2) == 200);
    assert_true(rounds_left(METHOD_PUP, 1000, 300, 0, 2) == 300); /* one round is enough */
    /* others keep the same share in each */
    assert_true(rounds_left(METHOD_EFFICIENTGS, 1000, 1, 0, 3) == 100);
    assert_true(rounds_left(METHOD_EFFICIENTGS, 1000, 1, 1, 3) == 10);
}

/* The Gaussians that remain are those of the unpruned model, in their order, for every rival. */
TEST(prunes_and_tunes)
{
    static uint8_t grey[SIDE * SIDE * 3];
    memset(grey, 128, sizeof grey);
    dice d = {3};
    splat_model whole = random_model(&d, COUNT, SIDE, SIDE, SIDE);
    splat_camera camera = middle_camera(SIDE, SIDE, SIDE);
    const finetune_target target = {camera, grey};
    splat_view view = view_of(&whole, &camera, SPLAT_ALPHA_LEAST);
    for (method_kind kind = METHOD_RANDOM; kind < METHOD_KIND_COUNT; kind++) {
        double score[COUNT];
        tuned_model tuned;
        const finetune_options options = {.iterations = 7};
        assert_true(score_of(kind, &whole, &view, 1, 1, score) && tuned_model_of(&tuned, &whole));
        assert_true(tune_rival(&tuned, kind, score, BUDGET, 1, &target, 1, &options, NULL));
        assert_true(tuned.model.count == BUDGET);
        for (uint32_t i = 0; i < BUDGET; i++) {
            assert_true(tuned.of[i] < COUNT && (i == 0 || tuned.of[i] > tuned.of[i - 1]));
            const double *now = parameters_of(&tuned.model, i), *was = parameters_of(&whole, tuned.of[i]);
            assert_true(hypot(now[0] - was[0], now[1] - was[1]) < 7 * 4 * finetune_rates_default.position);
        }
        tuned_model_free(&tuned);
    }
    splat_view_close(&view);
    splat_model_free(&whole);
}

/* Gaussians start as wide as their neighbours are far, or as wide as they were. */
TEST(pruned_widths)
{
    static uint8_t black[SIDE * SIDE * 3];
    splat_model whole = plain_model(3);
    set_ball(&whole, 0, 0.1, 0, 1, 0.05, 0.5);
    set_ball(&whole, 1, 0, 0, 1, 0.05, 0.5);
    set_ball(&whole, 2, -0.1, 0, 1, 0.05, 0.5);
    const finetune_target target = {middle_camera(SIDE, SIDE, SIDE), black};
    const double score[3] = {2, 1, 3};
    double width[2];
    for (int pruned = 0; pruned < 2; pruned++) {
        tuned_model tuned;
        const finetune_options options = {
            .iterations = 1, .rounds = 1, .pruned_widths = pruned == 1, .published_rates = true};
        assert_true(tuned_model_of(&tuned, &whole));
        assert_true(tune_rival(&tuned, METHOD_RANDOM, score, 2, 1, &target, 1, &options, NULL));
        assert_true(tuned.of[0] == 0 && tuned.of[1] == 2);
        width[pruned] = exp(parameters_of(&tuned.model, 0)[SPLAT_LOG_SCALE]);
        tuned_model_free(&tuned);
    }
    assert_near(width[0], 0.2, 0.2 * 0.006); /* the distance, and a step of fine-tuning */
    assert_near(width[1], 0.05, 0.05 * 0.006);
    splat_model_free(&whole);
}
