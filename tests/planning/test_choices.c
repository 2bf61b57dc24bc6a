/* SPDX-License-Identifier: Apache-2.0 */
/* Settings that fit: lists hold what they promise. */
#include <stdbool.h>
#include <stdlib.h>

#include "planning/choices.h"
#include "test.h"
#include "weights_maker.h"

static const chosen_head analytic = {.head = T3R_HEAD_ANALYTIC};

static t3r_config config_of(uint32_t gaussians)
{
    return t3r_default_config(96, 64, 2, gaussians);
}

static void check_list(const choice *list, uint32_t count, const choice_limits *limits)
{
    for (uint32_t i = 0; i < count; i++) {
        assert_true(limits->bytes == 0 || list[i].min_bytes <= limits->bytes);
        assert_true(limits->most == 0 || list[i].price <= limits->most);
        assert_true(limits->gaussians == 0 || list[i].gaussians == limits->gaussians);
        assert_true(limits->refine == CHOICES_ANY_REFINE || list[i].refine == limits->refine);
        for (uint32_t k = 0; k < i; k++) {
            assert_true(list[k].loss < list[i].loss ||
                        (list[k].loss == list[i].loss && list[k].price <= list[i].price));
            assert_true(list[i].full_bytes < list[k].full_bytes || list[i].price < list[k].price ||
                        list[i].loss < list[k].loss);
        }
    }
}

static uint32_t listed(const t3r_config *c, const choice_limits *limits, choice list[CHOICES_MOST])
{
    uint32_t count = 0;
    assert_int_equal(choices_add(c, &analytic, limits, list, &count), T3R_OK);
    assert_in_range(count, 0, CHOICES_MOST);
    check_list(list, count, limits);
    return count;
}

TEST(lists_what_fits_best_first)
{
    const t3r_config c = config_of(1);
    choice all[CHOICES_MOST], some[CHOICES_MOST];
    choice_limits limits = {.prices = &work_operations, .refine = CHOICES_ANY_REFINE};
    const uint32_t count = listed(&c, &limits, all);
    assert_true(count > 8 && all[0].loss < 1 && all[0].head == &analytic);
    /* each row is a configuration: a build in such an arena, and its work */
    t3r_config chosen = c;
    chosen_head_configure(&analytic, &chosen);
    chosen.gaussians = chosen.max_gaussians = all[0].gaussians;
    chosen.refine = all[0].refine;
    size_t least, most;
    work_counts work;
    assert_int_equal(t3r_plan_bytes(&chosen, &least, &most), T3R_OK);
    assert_int_equal(least, all[0].min_bytes);
    assert_int_equal(most, all[0].full_bytes);
    assert_int_equal(work_count(&chosen, most, NULL, &work), T3R_OK);
    assert_true(work_price_of_build(&work, &work_operations) == all[0].price);
    /* each limit cuts, and all rows of the shorter list are no better than before */
    limits.most = all[0].price / 2;
    assert_in_range(listed(&c, &limits, some), 1, count - 1);
    assert_true(some[0].loss >= all[0].loss);
    limits.bytes = all[count - 1].min_bytes;
    assert_in_range(listed(&c, &limits, some), 1, count - 1);
    limits.bytes = 1000;
    assert_int_equal(listed(&c, &limits, some), 0);
    limits = (choice_limits){.gaussians = 500, .refine = 3};
    assert_int_equal(listed(&c, &limits, some), 1);
    assert_true(some[0].price == 0);
}

/* The smallest scene has choices. Shares of the largest that no runtime accepts are left out. */
TEST(shares_of_extreme_sizes)
{
    choice list[CHOICES_MOST];
    const choice_limits limits = {.prices = &work_operations, .refine = 1};
    const t3r_config smallest = t3r_default_config(T3R_MIN_SIDE, T3R_MIN_SIDE, 1, 1);
    assert_true(listed(&smallest, &limits, list) > 0);
    const t3r_config largest = t3r_default_config(T3R_MAX_SIDE, T3R_MAX_SIDE, T3R_MAX_VIEWS, 1);
    const uint32_t count = listed(&largest, &limits, list);
    uint32_t most = 0;
    for (uint32_t i = 0; i < count; i++) {
        most = list[i].gaussians > most ? list[i].gaussians : most;
    }
    assert_in_range(most, T3R_MAX_GAUSSIANS / 2, T3R_MAX_GAUSSIANS);
}

TEST(heads_are_compared)
{
    choice list[2 * CHOICES_MOST];
    uint32_t count = 0, networks = 0;
    const choice_limits limits = {.prices = &work_operations, .refine = CHOICES_ANY_REFINE};
    t3r_config c = config_of(1);
    assert_int_equal(choices_add(&c, &analytic, &limits, list, &count), T3R_OK);
    const uint32_t before = count;
    size_t bytes;
    uint8_t *weights = make_weights(small_shape, small_layers, 8, 8, 1, &bytes);
    const chosen_head learned = {.head = T3R_HEAD_LEARNED, .weights = weights, .bytes = bytes};
    assert_int_equal(choices_add(&c, &learned, &limits, list, &count), T3R_OK);
    check_list(list, count, &limits);
    for (uint32_t i = 0; i < count; i++) {
        networks += list[i].head == &learned;
    }
    assert_true(networks > 0 && networks < count && count < before + CHOICES_MOST);
    free(weights);
}

/* A network is rated like the shipped one of about its size: one that computes more loses less at small budgets. */
TEST(networks_are_rated_by_their_size)
{
    static const made_layer least[] = {{T3R_LAYER_POINT, 0, {0, T3R_SOURCE_NONE}, 1, 1, 1, T3R_HEAD_OUTPUTS}};
    static const made_layer two[] = {{T3R_LAYER_POINT, 0, {0, T3R_SOURCE_NONE}, 1, 1, 1, 48},
                                     {T3R_LAYER_POINT, 0, {1, T3R_SOURCE_NONE}, 1, 1, 1, T3R_HEAD_OUTPUTS}};
    const struct {
        const made_layer *layers;
        uint32_t count;
        bool more;
    } sizes[] = {
        {least, 1, false}, {two, 2, false}, {small_shape, small_layers, true}, {wide_shape, wide_layers, true}};
    double loss[2] = {0};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        size_t bytes;
        uint8_t *weights = make_weights(sizes[i].layers, sizes[i].count, 8, 8, 1, &bytes);
        const t3r_config c = config_of(1);
        const chosen_head learned = {.head = T3R_HEAD_LEARNED, .weights = weights, .bytes = bytes};
        const choice_limits limits = {.gaussians = 96 * 64 * 2 / 49, .refine = 16}; /* just over 2 % of the points */
        choice list[CHOICES_MOST];
        uint32_t count = 0;
        assert_int_equal(choices_add(&c, &learned, &limits, list, &count), T3R_OK);
        assert_true(count == 1 && list[0].head == &learned);
        assert_true(loss[sizes[i].more] == 0 || loss[sizes[i].more] == list[0].loss);
        loss[sizes[i].more] = list[0].loss;
        free(weights);
    }
    assert_true(loss[true] < loss[false]);
}

TEST(refuses_what_no_runtime_takes)
{
    t3r_config c = config_of(1);
    choice list[CHOICES_MOST];
    uint32_t count = 0;
    const choice_limits limits = {.refine = 1};
    c.levels = 0;
    assert_int_equal(choices_add(&c, &analytic, &limits, list, &count), T3R_ERR_CONFIG);
    assert_int_equal(count, 0);
}
