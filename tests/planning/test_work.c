/* SPDX-License-Identifier: Apache-2.0 */
/* The work of builds: counts follow the configuration, prices add up. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "planning/work.h"
#include "test.h"
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

static work_counts counted(const t3r_config *config, const void *weights)
{
    work_counts work;
    assert_int_equal(work_count(config, bytes_of(config, true), weights, &work), T3R_OK);
    return work;
}

/* ---- counts ------------------------------------------------------------------------------------------------------ */

TEST(counts_follow_the_configuration)
{
    t3r_config c = config_of(1000);
    c.align = 0;
    const work_counts before = counted(&c, NULL);
    const uint64_t points = 96 * 64 * 2;
    assert_int_equal(before.units[WORK_IMAGE], points);
    assert_int_equal(before.units[WORK_COMPARISON], points);
    assert_int_equal(before.units[WORK_DISC_GAUSSIANS], 1000);
    assert_int_equal(before.units[WORK_MACS] + before.units[WORK_UNPACKED_MACS], 0);
    assert_int_equal(before.units[WORK_REFINE_PIXELS], c.refine * points);
    assert_int_equal(before.units[WORK_CORRECTIONS], c.refine * 1000);
    c.refine *= 2;
    assert_int_equal(counted(&c, NULL).units[WORK_REFINE_GAUSSIANS], 2 * before.units[WORK_REFINE_GAUSSIANS]);
    c.clusters = 1; /* a single cluster needs no search */
    assert_int_equal(counted(&c, NULL).units[WORK_LABELS], 0);
    assert_int_equal(counted(&c, NULL).units[WORK_BUDGET], points);
    c.views = 0;
    assert_int_equal(counted(&c, NULL).units[WORK_LABELS], 0);
    assert_int_equal(counted(&c, NULL).units[WORK_RASTER_PIXELS], 96 * 64);
    c = config_of(1000);
    c.depth = T3R_DEPTH_STEREO;
    assert_int_equal(counted(&c, NULL).units[WORK_STEREO], 96 * 64);
    assert_int_equal(counted(&c, NULL).units[WORK_DEPTH], 0);
}

/* Half of at most 32 rounds compare 1,024 pixels of each view, and only if alignment has two views. */
TEST(alignment_compares_pixels)
{
    t3r_config c = config_of(1000);
    const uint64_t both = counted(&c, NULL).units[WORK_COMPARISON];
    c.align = 0;
    const uint64_t plain = counted(&c, NULL).units[WORK_COMPARISON];
    assert_int_equal(both - plain, 16 * 2 * 1024);
    c.align = 1;
    c.depth = T3R_DEPTH_STEREO;
    assert_int_equal(counted(&c, NULL).units[WORK_COMPARISON], plain);
    c = config_of(1000);
    c.views = 1;
    assert_int_equal(counted(&c, NULL).units[WORK_COMPARISON], 0);
}

/* Fitted widths look at the other views; structure, at the tiles once more and at all views' levels in two passes. */
TEST(counts_what_is_asked_for_beyond)
{
    t3r_config c = config_of(1000);
    c.fit_widths = 1;
    assert_int_equal(counted(&c, NULL).units[WORK_DISC_GAUSSIANS], 1000); /* refinement finds widths by itself */
    c.refine = 0;
    assert_int_equal(counted(&c, NULL).units[WORK_DISC_GAUSSIANS], 1000 + 1000 / 5);
    c.fit_widths = 0;
    assert_int_equal(counted(&c, NULL).units[WORK_DISC_GAUSSIANS], 1000);
    for (uint32_t views = 1; views <= 2; views++) {
        for (uint32_t passes = 1; passes <= 4; passes++) {
            c = t3r_default_config(96, 64, views, 1000);
            c.refine = passes;
            const work_counts plain = counted(&c, NULL);
            c.structural = 1;
            const work_counts work = counted(&c, NULL);
            const uint64_t pixels = plain.units[WORK_REFINE_PIXELS], levelled = passes < 2 ? passes : 2;
            assert_int_equal(work.units[WORK_REFINE_PIXELS], pixels + pixels / 16);
            assert_int_equal(work.units[WORK_REFINE_GAUSSIANS] - plain.units[WORK_REFINE_GAUSSIANS],
                             views > 1 ? levelled * views * 1000 : 0);
        }
    }
}

/* A small arena refines the Gaussians in slices, each of which draws the views. */
TEST(small_arenas_draw_more_often)
{
    const t3r_config c = config_of(4000);
    work_counts least;
    const size_t bytes = bytes_of(&c, false);
    assert_int_equal(work_count(&c, bytes, NULL, &least), T3R_OK);
    const uint64_t times = least.units[WORK_REFINE_PIXELS] / counted(&c, NULL).units[WORK_REFINE_PIXELS];
    assert_in_range(times, 2, 8);
    assert_int_equal(work_count(&c, bytes - 1, NULL, &least), T3R_ERR_ARENA);
}

TEST(networks_count_by_their_layers)
{
    size_t bytes;
    uint8_t *weights = make_weights(small_shape, small_layers, 8, 8, 1, &bytes);
    t3r_config c = config_of(96 * 64 * 2); /* every point, so that a pixel takes what the header says */
    c.head = T3R_HEAD_LEARNED;
    const work_counts work = counted(&c, weights);
    const uint64_t macs = work.units[WORK_MACS] + work.units[WORK_UNPACKED_MACS];
    const uint64_t said = (uint64_t)t3r_weights_header_of(weights).macs_q8 * 96 * 64 * 2 / 256;
    assert_in_range(macs, said - said / 100, said + said / 100);
    free(weights);
}

/* Networks whose numbers or layers cannot be packed count as slower. */
TEST(some_networks_cannot_be_packed)
{
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
        c.head_column_bytes = T3R_MAX_HEAD_COLUMN_BYTES; /* room for either */
        const work_counts work = counted(&c, weights);
        assert_int_equal(work.units[WORK_MACS] > 0, cases[i].packed);
        assert_int_equal(work.units[WORK_UNPACKED_MACS] > 0, !cases[i].packed);
        free(weights);
    }
}

TEST(refuses_what_no_runtime_takes)
{
    t3r_config c = config_of(100);
    work_counts work;
    assert_int_equal(work_count(&c, 0, NULL, &work), T3R_ERR_ARENA);
    c.clusters = T3R_MAX_CLUSTERS + 1;
    assert_int_equal(work_count(&c, SIZE_MAX / 2, NULL, &work), T3R_ERR_CONFIG);
}

TEST(prices_add_up_by_stage)
{
    work_counts work = {{0}};
    work_prices prices = {{0}};
    work.units[WORK_IMAGE] = 2000;
    work.units[WORK_MACS] = UINT64_C(1) << 40;
    work.units[WORK_LIFTS] = 7;
    work.units[WORK_RASTER_PIXELS] = 5;
    prices.milli[WORK_IMAGE] = 1500;
    prices.milli[WORK_MACS] = UINT32_MAX;
    prices.milli[WORK_LIFTS] = 2000;
    prices.milli[WORK_RASTER_PIXELS] = 2000;
    const double head = 1099511627776.0 * 4294967.295 + 14;
    assert_true(work_price(&work, &prices, T3R_STAGE_IMAGE) == 3000);
    assert_true(work_price(&work, &prices, T3R_STAGE_RASTER) == 10);
    assert_true(work_price(&work, &prices, T3R_STAGE_BUDGET) == 0);
    assert_true(fabs(work_price(&work, &prices, T3R_STAGE_HEAD) / head - 1) < 1e-15);
    assert_true(fabs(work_price_of_build(&work, &prices) / (3000 + head) - 1) < 1e-15);
}

TEST(kinds_have_names_and_stages)
{
    for (int kind = 0; kind < WORK_KIND_COUNT; kind++) {
        assert_in_range(work_stage((work_kind)kind), 0, T3R_STAGE_COUNT - 1);
        for (int other = 0; other < kind; other++) {
            assert_string_not_equal(work_name((work_kind)kind), work_name((work_kind)other));
        }
    }
    assert_string_equal(work_name(WORK_MACS), "macs");
    assert_int_equal(work_stage(WORK_MACS), T3R_STAGE_HEAD);
}
