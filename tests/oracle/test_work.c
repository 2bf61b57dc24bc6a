/* SPDX-License-Identifier: Apache-2.0 */
/* The work of builds and the settings that fit: counts follow the configuration, lists keep their promises. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "trim3r.h"
#include "weights_maker.h"

static t3r_config config_of(uint32_t gaussians)
{
    return t3r_default_config(96, 64, 2, gaussians);
}

static size_t bytes_of(const t3r_config *config, bool full)
{
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(config, &plan), T3R_OK);
    return full ? plan.bytes : plan.min_bytes;
}

static t3r_work_counts counted(const t3r_config *config, const void *weights, size_t weight_bytes)
{
    t3r_work_counts work;
    assert_int_equal(t3r_count_work(config, bytes_of(config, true), weights, weight_bytes, &work), T3R_OK);
    return work;
}

/* ---- counts ------------------------------------------------------------------------------------------------------ */

static void counts_follow_the_configuration(void **state)
{
    (void)state;
    t3r_config c = config_of(1000);
    c.align = 0;
    const t3r_work_counts before = counted(&c, NULL, 0);
    const uint64_t points = 96 * 64 * 2;
    assert_int_equal(before.units[T3R_WORK_IMAGE], points);
    assert_int_equal(before.units[T3R_WORK_COMPARISON], points);
    assert_int_equal(before.units[T3R_WORK_DISC_GAUSSIANS], 1000);
    assert_int_equal(before.units[T3R_WORK_MACS] + before.units[T3R_WORK_UNPACKED_MACS], 0);
    assert_int_equal(before.units[T3R_WORK_REFINE_PIXELS], c.refine * points);
    assert_int_equal(before.units[T3R_WORK_CORRECTIONS], c.refine * 1000);
    c.refine *= 2;
    assert_int_equal(counted(&c, NULL, 0).units[T3R_WORK_REFINE_GAUSSIANS],
                     2 * before.units[T3R_WORK_REFINE_GAUSSIANS]);
    c.clusters = 1; /* a single cluster needs no search */
    assert_int_equal(counted(&c, NULL, 0).units[T3R_WORK_LABELS], 0);
    assert_int_equal(counted(&c, NULL, 0).units[T3R_WORK_BUDGET], points);
    c.views = 0;
    assert_int_equal(counted(&c, NULL, 0).units[T3R_WORK_LABELS], 0);
    assert_int_equal(counted(&c, NULL, 0).units[T3R_WORK_RASTER_PIXELS], 96 * 64);
    c = config_of(1000);
    c.depth = T3R_DEPTH_STEREO;
    assert_int_equal(counted(&c, NULL, 0).units[T3R_WORK_STEREO], 96 * 64);
    assert_int_equal(counted(&c, NULL, 0).units[T3R_WORK_DEPTH], 0);
}

/* Half of at most 32 rounds compare 1,024 pixels of each view, and only if alignment has two views. */
static void alignment_compares_pixels(void **state)
{
    (void)state;
    t3r_config c = config_of(1000);
    const uint64_t both = counted(&c, NULL, 0).units[T3R_WORK_COMPARISON];
    c.align = 0;
    const uint64_t plain = counted(&c, NULL, 0).units[T3R_WORK_COMPARISON];
    assert_int_equal(both - plain, 16 * 2 * 1024);
    c.align = 1;
    c.depth = T3R_DEPTH_STEREO;
    assert_int_equal(counted(&c, NULL, 0).units[T3R_WORK_COMPARISON], plain);
    c = config_of(1000);
    c.views = 1;
    assert_int_equal(counted(&c, NULL, 0).units[T3R_WORK_COMPARISON], 0);
}

/* Fitted widths examine the other views; structure examines the tiles once more and the levels of all views in two
 * passes. */
static void counts_what_is_asked_for_beyond(void **state)
{
    (void)state;
    t3r_config c = config_of(1000);
    c.fit_widths = 1;
    assert_int_equal(counted(&c, NULL, 0).units[T3R_WORK_DISC_GAUSSIANS], 1000); /* refinement finds widths itself */
    c.refine = 0;
    assert_int_equal(counted(&c, NULL, 0).units[T3R_WORK_DISC_GAUSSIANS], 1000 + 1000 / 5);
    c.fit_widths = 0;
    assert_int_equal(counted(&c, NULL, 0).units[T3R_WORK_DISC_GAUSSIANS], 1000);
    for (uint32_t views = 1; views <= 2; views++) {
        for (uint32_t passes = 1; passes <= 4; passes++) {
            c = t3r_default_config(96, 64, views, 1000);
            c.refine = passes;
            const t3r_work_counts plain = counted(&c, NULL, 0);
            c.structural = 1;
            const t3r_work_counts work = counted(&c, NULL, 0);
            const uint64_t pixels = plain.units[T3R_WORK_REFINE_PIXELS], levelled = passes < 2 ? passes : 2;
            assert_int_equal(work.units[T3R_WORK_REFINE_PIXELS], pixels + pixels / 16);
            assert_int_equal(work.units[T3R_WORK_REFINE_GAUSSIANS] - plain.units[T3R_WORK_REFINE_GAUSSIANS],
                             views > 1 ? levelled * views * 1000 : 0);
        }
    }
}

/* If memory is too small for all at once, refinement works in slices, each of which draws the views. */
static void small_arenas_draw_more_often(void **state)
{
    (void)state;
    const t3r_config c = config_of(4000);
    t3r_work_counts least;
    const size_t bytes = bytes_of(&c, false);
    assert_int_equal(t3r_count_work(&c, bytes, NULL, 0, &least), T3R_OK);
    const uint64_t times = least.units[T3R_WORK_REFINE_PIXELS] / counted(&c, NULL, 0).units[T3R_WORK_REFINE_PIXELS];
    assert_in_range(times, 2, 8);
    assert_int_equal(t3r_count_work(&c, bytes - 1, NULL, 0, &least), T3R_ERR_ARENA);
}

static void networks_count_by_their_layers(void **state)
{
    (void)state;
    size_t bytes;
    uint8_t *weights = make_weights(small_shape, small_layers, 8, 8, 1, &bytes);
    t3r_config c = config_of(96 * 64 * 2); /* every point, so that the cost per pixel is the header's */
    c.head = T3R_HEAD_LEARNED;
    t3r_work_counts work = counted(&c, weights, bytes);
    const uint64_t macs = work.units[T3R_WORK_MACS] + work.units[T3R_WORK_UNPACKED_MACS];
    const uint64_t told = (uint64_t)t3r_weights_header_of(weights).macs_q8 * 96 * 64 * 2 / 256;
    assert_in_range(macs, told - told / 100, told + told / 100);
    assert_int_equal(t3r_count_work(&c, bytes_of(&c, true), NULL, 0, &work), T3R_ERR_WEIGHTS);
    weights[bytes - 1] ^= 1;
    assert_int_equal(t3r_count_work(&c, bytes_of(&c, true), weights, bytes, &work), T3R_ERR_WEIGHTS);
    free(weights);
}

/* Networks whose numbers or layers cannot be packed count as slower. */
static void some_networks_cannot_be_packed(void **state)
{
    (void)state;
    static const made_layer deep[] = {
        {T3R_LAYER_CONV, 1, {0, T3R_SOURCE_NONE}, 4, 2, 1, 8},
        {T3R_LAYER_DEPTHWISE, 1, {1, T3R_SOURCE_NONE}, 3, 1, 1, 8},
        {T3R_LAYER_POINT, 0, {2, T3R_SOURCE_NONE}, 1, 1, 1, T3R_HEAD_OUTPUTS},
    };
    static const struct {
        const made_layer *layers;
        uint32_t weight_bits, activation_bits, packed;
    } cases[] = {{small_shape, 8, 8, 1}, {small_shape, 16, 8, 0}, {small_shape, 8, 16, 0}, {deep, 8, 8, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        size_t bytes;
        const uint32_t layers = cases[i].layers == deep ? 3 : small_layers;
        uint8_t *weights =
            make_weights(cases[i].layers, layers, cases[i].weight_bits, cases[i].activation_bits, 1, &bytes);
        t3r_config c = config_of(1000);
        c.head = T3R_HEAD_LEARNED;
        c.head_column_bytes = T3R_MAX_HEAD_COLUMN_BYTES; /* room for both */
        const t3r_work_counts work = counted(&c, weights, bytes);
        assert_int_equal(work.units[T3R_WORK_MACS] > 0, cases[i].packed);
        assert_int_equal(work.units[T3R_WORK_UNPACKED_MACS] > 0, !cases[i].packed);
        free(weights);
    }
}

static void refuses_what_has_no_count(void **state)
{
    (void)state;
    t3r_config c = config_of(100);
    t3r_work_counts work;
    assert_int_equal(t3r_count_work(NULL, 0, NULL, 0, &work), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_count_work(&c, 0, NULL, 0, NULL), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_count_work(&c, 0, NULL, 0, &work), T3R_ERR_ARENA);
    c.stream = 1;
    assert_int_equal(t3r_count_work(&c, SIZE_MAX / 2, NULL, 0, &work), T3R_ERR_CONFIG);
    c.stream = 0;
    c.clusters = T3R_MAX_CLUSTERS + 1;
    assert_int_equal(t3r_count_work(&c, SIZE_MAX / 2, NULL, 0, &work), T3R_ERR_CONFIG);
}

static void prices_add_up_and_end_at_the_most(void **state)
{
    (void)state;
    t3r_work_counts work = {{0}};
    t3r_prices prices = {{0}};
    work.units[T3R_WORK_IMAGE] = 1999;
    work.units[T3R_WORK_BUDGET] = 7;
    work.units[T3R_WORK_RASTER_PIXELS] = 5;
    prices.milli[T3R_WORK_IMAGE] = 1500;
    prices.milli[T3R_WORK_BUDGET] = 1000;
    prices.milli[T3R_WORK_RASTER_PIXELS] = 2000;
    assert_int_equal(t3r_price_of(&work, &prices, T3R_STAGE_IMAGE), 2998);
    assert_int_equal(t3r_price_of(&work, &prices, T3R_STAGE_RASTER), 10);
    assert_int_equal(t3r_price_of(&work, &prices, T3R_STAGE_HEAD), 0);
    assert_int_equal(t3r_price_of_build(&work, &prices), 2998 + 7);
    work.units[T3R_WORK_IMAGE] = UINT64_MAX;
    prices.milli[T3R_WORK_IMAGE] = UINT32_MAX;
    assert_true(t3r_price_of(&work, &prices, T3R_STAGE_IMAGE) == UINT64_MAX);
    assert_true(t3r_price_of_build(&work, &prices) == UINT64_MAX);
    /* a product that overflows, and a thousandth of it that fits: the difference is below one price */
    work.units[T3R_WORK_IMAGE] = UINT64_MAX;
    work.units[T3R_WORK_BUDGET] = 0;
    prices.milli[T3R_WORK_IMAGE] = 999;
    const uint64_t exact = UINT64_MAX / 1000 * 999 + UINT64_MAX % 1000 * 999 / 1000;
    assert_in_range(exact - t3r_price_of(&work, &prices, T3R_STAGE_IMAGE), 0, 998);
}

/* ---- lists ------------------------------------------------------------------------------------------------------- */

static void check_list(const t3r_choice *list, uint32_t count, const t3r_limits *limits)
{
    for (uint32_t i = 0; i < count; i++) {
        assert_true(limits->bytes == 0 || list[i].min_bytes <= limits->bytes);
        assert_true(limits->most == 0 || list[i].price <= limits->most);
        assert_true(limits->gaussians == 0 || list[i].gaussians == limits->gaussians);
        assert_true(limits->refine == T3R_ANY_REFINE || list[i].refine == limits->refine);
        for (uint32_t k = 0; k < i; k++) {
            assert_true(list[k].loss_q4 < list[i].loss_q4 ||
                        (list[k].loss_q4 == list[i].loss_q4 && list[k].price <= list[i].price));
            assert_true(list[i].full_bytes < list[k].full_bytes || list[i].price < list[k].price ||
                        list[i].loss_q4 < list[k].loss_q4);
        }
    }
}

static uint32_t listed(const t3r_config *c, const t3r_limits *limits, t3r_choice list[T3R_MAX_CHOICES])
{
    uint32_t count = 0;
    assert_int_equal(t3r_plan_choices(c, NULL, 0, limits, list, &count), T3R_OK);
    assert_in_range(count, 0, T3R_MAX_CHOICES);
    check_list(list, count, limits);
    return count;
}

static void lists_what_fits_best_first(void **state)
{
    (void)state;
    const t3r_config c = config_of(1);
    t3r_choice all[T3R_MAX_CHOICES], some[T3R_MAX_CHOICES];
    t3r_limits limits = {.prices = &t3r_operations, .refine = T3R_ANY_REFINE};
    const uint32_t count = listed(&c, &limits, all);
    assert_true(count > 8 && all[0].loss_q4 < 16 && all[0].head == T3R_HEAD_ANALYTIC);
    /* each row is a configuration: build it in an arena of that size, and count its work */
    t3r_config chosen = c;
    chosen.gaussians = chosen.max_gaussians = all[0].gaussians;
    chosen.refine = all[0].refine;
    const t3r_work_counts work = counted(&chosen, NULL, 0);
    assert_int_equal(bytes_of(&chosen, true), all[0].full_bytes);
    assert_int_equal(t3r_price_of_build(&work, &t3r_operations), all[0].price);
    /* each limit removes rows, and no row of the shorter list is better than before */
    limits.most = all[0].price / 2;
    assert_in_range(listed(&c, &limits, some), 1, count - 1);
    assert_true(some[0].loss_q4 >= all[0].loss_q4);
    limits.bytes = all[count - 1].min_bytes;
    assert_in_range(listed(&c, &limits, some), 1, count - 1);
    limits.bytes = 1000;
    assert_int_equal(listed(&c, &limits, some), 0);
    limits = (t3r_limits){.gaussians = 500, .refine = 3};
    assert_int_equal(listed(&c, &limits, some), 1);
    assert_int_equal(some[0].price, 0);
}

/* Shares of the smallest scene are at least one Gaussian; shares of the largest omit those that no runtime accepts. */
static void shares_of_extreme_sizes(void **state)
{
    (void)state;
    t3r_choice list[T3R_MAX_CHOICES];
    const t3r_limits limits = {.prices = &t3r_operations, .refine = 1};
    t3r_config c = t3r_default_config(T3R_MIN_SIDE, T3R_MIN_SIDE, 1, 1);
    uint32_t count = listed(&c, &limits, list), least = UINT32_MAX, most = 0;
    for (uint32_t i = 0; i < count; i++) {
        least = list[i].gaussians < least ? list[i].gaussians : least;
    }
    assert_int_equal(least, 1);
    c = t3r_default_config(T3R_MAX_SIDE, T3R_MAX_SIDE, T3R_MAX_VIEWS, 1);
    count = listed(&c, &limits, list);
    for (uint32_t i = 0; i < count; i++) {
        most = list[i].gaussians > most ? list[i].gaussians : most;
    }
    assert_in_range(most, T3R_MAX_GAUSSIANS / 2, T3R_MAX_GAUSSIANS);
}

static void heads_are_compared(void **state)
{
    (void)state;
    t3r_choice list[2 * T3R_MAX_CHOICES];
    uint32_t count = 0, learned = 0;
    const t3r_limits limits = {.prices = &t3r_operations, .refine = T3R_ANY_REFINE};
    t3r_config c = config_of(1);
    assert_int_equal(t3r_plan_choices(&c, NULL, 0, &limits, list, &count), T3R_OK);
    const uint32_t before = count;
    size_t bytes;
    uint8_t *weights = make_weights(small_shape, small_layers, 8, 8, 1, &bytes);
    c.head = T3R_HEAD_LEARNED;
    assert_int_equal(t3r_plan_choices(&c, weights, bytes, &limits, list, &count), T3R_OK);
    check_list(list, count, &limits);
    for (uint32_t i = 0; i < count; i++) {
        learned += list[i].head == T3R_HEAD_LEARNED;
    }
    assert_true(learned > 0 && learned < count && count < before + T3R_MAX_CHOICES);
    free(weights);
}

/* A network is rated like the shipped one of similar size: one that computes more loses less at small budgets. */
static void networks_are_rated_by_their_size(void **state)
{
    (void)state;
    static const made_layer least[] = {{T3R_LAYER_POINT, 0, {0, T3R_SOURCE_NONE}, 1, 1, 1, T3R_HEAD_OUTPUTS}};
    static const made_layer two[] = {{T3R_LAYER_POINT, 0, {0, T3R_SOURCE_NONE}, 1, 1, 1, 48},
                                     {T3R_LAYER_POINT, 0, {1, T3R_SOURCE_NONE}, 1, 1, 1, T3R_HEAD_OUTPUTS}};
    const struct {
        const made_layer *layers;
        uint32_t count;
        bool more;
    } sizes[] = {
        {least, 1, false}, {two, 2, false}, {small_shape, small_layers, true}, {wide_shape, wide_layers, true}};
    uint32_t loss[2] = {0};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        size_t bytes;
        uint8_t *weights = make_weights(sizes[i].layers, sizes[i].count, 8, 8, 1, &bytes);
        t3r_config c = config_of(1);
        c.head = T3R_HEAD_LEARNED;
        c.head_column_bytes = T3R_MAX_HEAD_COLUMN_BYTES;
        const t3r_limits limits = {.gaussians = 96 * 64 * 2 / 49, .refine = 16}; /* just over 2 % of the points */
        t3r_choice list[T3R_MAX_CHOICES];
        uint32_t count = 0;
        assert_int_equal(t3r_plan_choices(&c, weights, bytes, &limits, list, &count), T3R_OK);
        assert_true(count == 1 && list[0].weights == weights);
        assert_true(loss[sizes[i].more] == 0 || loss[sizes[i].more] == list[0].loss_q4);
        loss[sizes[i].more] = list[0].loss_q4;
        assert_int_equal(t3r_plan_choices(&c, weights, bytes - 16, &limits, list, &count), T3R_ERR_WEIGHTS);
        free(weights);
    }
    assert_true(loss[true] < loss[false]);
}

static void refuses_limits_out_of_range(void **state)
{
    (void)state;
    t3r_config c = config_of(1);
    t3r_choice list[T3R_MAX_CHOICES];
    uint32_t count = 0;
    const t3r_limits bad[] = {
        {.most = 5, .refine = 1}, {.gaussians = T3R_MAX_GAUSSIANS + 1}, {.refine = T3R_MAX_REFINE + 1}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(t3r_plan_choices(&c, NULL, 0, &bad[i], list, &count), T3R_ERR_ARGUMENT);
    }
    const t3r_limits good = {.refine = 1};
    assert_int_equal(t3r_plan_choices(NULL, NULL, 0, &good, list, &count), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_plan_choices(&c, NULL, 0, NULL, list, &count), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_plan_choices(&c, NULL, 0, &good, NULL, &count), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_plan_choices(&c, NULL, 0, &good, list, NULL), T3R_ERR_ARGUMENT);
    c.head = T3R_HEAD_LEARNED;
    assert_int_equal(t3r_plan_choices(&c, NULL, 0, &good, list, &count), T3R_ERR_WEIGHTS);
    c.levels = 0;
    assert_int_equal(t3r_plan_choices(&c, NULL, 0, &good, list, &count), T3R_ERR_CONFIG);
    c = config_of(1);
    c.stream = 1; /* with streams, keyframes come one at a time */
    assert_int_equal(t3r_plan_choices(&c, NULL, 0, &good, list, &count), T3R_ERR_CONFIG);
    assert_int_equal(count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_follow_the_configuration),
        cmocka_unit_test(alignment_compares_pixels),
        cmocka_unit_test(counts_what_is_asked_for_beyond),
        cmocka_unit_test(small_arenas_draw_more_often),
        cmocka_unit_test(networks_count_by_their_layers),
        cmocka_unit_test(some_networks_cannot_be_packed),
        cmocka_unit_test(refuses_what_has_no_count),
        cmocka_unit_test(prices_add_up_and_end_at_the_most),
        cmocka_unit_test(lists_what_fits_best_first),
        cmocka_unit_test(shares_of_extreme_sizes),
        cmocka_unit_test(heads_are_compared),
        cmocka_unit_test(networks_are_rated_by_their_size),
        cmocka_unit_test(refuses_limits_out_of_range),
    };
    return cmocka_run_group_tests_name("work", tests, NULL, NULL);
}
