/* SPDX-License-Identifier: Apache-2.0 */
/* The budget stage alone: exact quotas in every mode, nested sets, and the largest counts of any configuration. */
#include <stdlib.h>
#include <string.h>

#include "budget/budget.h"
#include "budget/cluster_texture.h"
#include "core/fixed.h"
#include "test.h"

enum { SIDE = 96, PIXELS = SIDE * SIDE, CLUSTERS = 40, WORDS = (PIXELS + 31) / 32 };

/* One worker. */
static t3r_group_count counts[T3R_MAX_CLUSTERS + 1];
static const t3r_budget_work alone = {{NULL, 1}, counts, &t3r_kernels_c};

static uint16_t texture[PIXELS], key[PIXELS];
static uint8_t label[PIXELS], validity[PIXELS];
static uint32_t mask[WORDS];

static t3r_view made_up_view(t3r_cluster *clusters)
{
    memset(clusters, 0, CLUSTERS * sizeof *clusters);
    for (uint32_t i = 0; i < PIXELS; i++) {
        uint32_t noise = t3r_mix32(i);
        texture[i] = (uint16_t)(noise % 7 == 0 ? noise >> 18 : (i % SIDE) * 8);
        label[i] = (uint8_t)((i / 64) % (CLUSTERS - 3)); /* three stay empty */
        validity[i] = i % 11 == 0 ? T3R_NO_DEPTH : T3R_MEASURED;
        clusters[label[i]].points += validity[i] == T3R_MEASURED;
    }
    return (t3r_view){.width = SIDE,
                      .height = SIDE,
                      .validity = validity,
                      .texture = texture,
                      .key = key,
                      .label = label,
                      .mask = mask};
}

static uint32_t retained_of(const t3r_view *view)
{
    uint32_t count = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        if (t3r_retained(view, i)) {
            assert_true(t3r_has_depth(validity[i]));
            count++;
        }
    }
    return count;
}

static t3r_budget_settings settings_of(t3r_allocation allocation, uint32_t gaussians)
{
    return (t3r_budget_settings){.allocate = allocation,
                                 .gaussians = gaussians,
                                 .keep_percent = 10,
                                 .gamma_q8 = 179,
                                 .clusters = CLUSTERS,
                                 .seed = 1};
}

TEST(every_mode_meets_every_budget)
{
    t3r_cluster clusters[CLUSTERS + 1];
    t3r_view view = made_up_view(clusters);
    t3r_cluster_texture(&view, 1, clusters, CLUSTERS);
    t3r_rank_clusters(clusters, CLUSTERS);
    uint32_t valid = 0;
    for (uint32_t k = 0; k < CLUSTERS; k++) {
        valid += clusters[k].points;
    }
    for (int mode = T3R_ALLOCATE_CONFIGURED + 1; mode < T3R_ALLOCATE_COUNT; mode++) {
        const uint32_t budgets[] = {1, 2, 39, 40, 41, 500, valid / 2, valid - 1, valid, valid + 1, 1u << 24};
        for (size_t b = 0; b < sizeof budgets / sizeof budgets[0]; b++) {
            t3r_budget_settings settings = settings_of((t3r_allocation)mode, budgets[b]);
            t3r_allocate(&view, 1, &settings, clusters, &alone);
            assert_int_equal(retained_of(&view), budgets[b] < valid ? budgets[b] : valid);
        }
    }
}

TEST(sets_are_nested)
{
    t3r_cluster clusters[CLUSTERS + 1];
    t3r_view view = made_up_view(clusters);
    const t3r_allocation flat[] = {T3R_ALLOCATE_PIXEL, T3R_ALLOCATE_UNIFORM, T3R_ALLOCATE_RANDOM};
    for (size_t m = 0; m < 3; m++) {
        uint32_t before[WORDS] = {0};
        for (uint32_t budget = 10; budget < PIXELS; budget += 371) {
            t3r_budget_settings settings = settings_of(flat[m], budget);
            t3r_allocate(&view, 1, &settings, clusters, &alone);
            for (size_t w = 0; w < WORDS; w++) {
                assert_int_equal(before[w] & ~mask[w], 0);
                before[w] = mask[w];
            }
        }
    }
}

/* `paper`: the lowest textures are cut first, the last cluster only until Z is exact. */
TEST(paper_takes_the_lowest_textures_first)
{
    t3r_cluster clusters[CLUSTERS + 1];
    t3r_view view = made_up_view(clusters);
    t3r_cluster_texture(&view, 1, clusters, CLUSTERS);
    t3r_rank_clusters(clusters, CLUSTERS);
    uint32_t valid = 0;
    for (uint32_t k = 0; k < CLUSTERS; k++) {
        valid += clusters[k].points;
        assert_true(k == 0 || clusters[clusters[k - 1].order].texture_q4 <= clusters[clusters[k].order].texture_q4);
    }
    t3r_budget_settings settings = settings_of(T3R_ALLOCATE_PAPER, valid * 6 / 10);
    t3r_allocate(&view, 1, &settings, clusters, &alone);
    int stage = 0; /* 0: cut to N %, 1: cut partly, 2: whole */
    for (uint32_t k = 0; k < CLUSTERS; k++) {
        const t3r_cluster *c = &clusters[clusters[k].order];
        uint32_t least = (c->points * 10 + 50) / 100;
        if (c->points == 0) {
            continue;
        }
        if (stage == 0 && c->quota != least) {
            stage = 1;
        } else if (stage >= 1) {
            stage = 2;
        }
        assert_true(stage == 0 ? c->quota == least : stage == 1 ? c->quota >= least : c->quota == c->points);
    }
    assert_int_equal(stage, 2);
}

/* Points without planes of that size: products must hold 2^28 points. */
TEST(largest_counts_do_not_overflow)
{
    t3r_cluster scratch[CLUSTERS + 1];
    t3r_view view = made_up_view(scratch);
    for (uint32_t shared = 1; shared <= 4; shared++) {
        t3r_cluster clusters[CLUSTERS + 1];
        memset(clusters, 0, sizeof clusters);
        for (uint32_t k = 0; k < shared; k++) {
            clusters[k].points = (1u << 28) / shared;
        }
        t3r_budget_settings settings = settings_of(T3R_ALLOCATE_DENSITY, 1000);
        t3r_allocate(&view, 1, &settings, clusters, &alone);
        uint64_t sum = 0;
        for (uint32_t k = 0; k < CLUSTERS; k++) {
            sum += clusters[k].quota;
        }
        assert_int_equal(sum, 1000);
    }
}

/* Covered and doubtful points: none until all others are retained, the doubtful ones last; Z stays exact. */
TEST(deferred_comes_last)
{
    t3r_cluster clusters[CLUSTERS + 1];
    t3r_view view = made_up_view(clusters);
    t3r_cluster_texture(&view, 1, clusters, CLUSTERS);
    t3r_rank_clusters(clusters, CLUSTERS);
    uint32_t plain = 0, covered = 0, doubtful = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        if (t3r_has_depth(validity[i])) {
            uint32_t kind = label[i] == 3 ? 1 : t3r_mix32(i + 99) % 8; /* all of one cluster is covered */
            validity[i] = kind == 0  ? T3R_MEASURED | T3R_MARK_DOUBTFUL
                          : kind < 4 ? T3R_MEASURED | T3R_MARK_COVERED
                                     : T3R_MEASURED;
            doubtful += kind == 0;
            covered += kind > 0 && kind < 4;
            plain += kind >= 4;
        }
    }
    for (int mode = T3R_ALLOCATE_CONFIGURED + 1; mode < T3R_ALLOCATE_GIVEN; mode++) {
        for (int pass_over = 0; pass_over < 2; pass_over++) {
            const uint32_t open = pass_over ? plain : plain + covered;
            const uint32_t budgets[] = {1,
                                        40,
                                        open / 2,
                                        open - 1,
                                        open,
                                        open + 1,
                                        plain + covered,
                                        plain + covered + 1,
                                        plain + covered + doubtful - 1,
                                        plain + covered + doubtful,
                                        1u << 24};
            for (size_t b = 0; b < sizeof budgets / sizeof budgets[0]; b++) {
                t3r_budget_settings settings = settings_of((t3r_allocation)mode, budgets[b]);
                settings.pass_over_covered = pass_over;
                t3r_allocate(&view, 1, &settings, clusters, &alone);
                uint32_t z = T3R_MIN(budgets[b], plain + covered + doubtful), passed = 0, flying = 0;
                assert_int_equal(retained_of(&view), z);
                for (size_t i = 0; i < PIXELS; i++) {
                    if (t3r_retained(&view, i)) {
                        passed += pass_over && t3r_is_covered(validity[i]);
                        flying += t3r_is_doubtful(validity[i]);
                        if (t3r_is_deferred(&view, i, &settings)) {
                            assert_int_equal(t3r_log_density_q10(&view, i, &settings, clusters), 0);
                        }
                    }
                }
                assert_int_equal(flying, z > plain + covered ? z - plain - covered : 0);
                assert_int_equal(passed, pass_over && z > plain ? T3R_MIN(z - plain, covered) : 0);
            }
        }
    }
    assert_true(t3r_is_sparse(&view, 1, 2 * plain / 3));
    assert_false(t3r_is_sparse(&view, 1, 2 * plain / 3 + 1));
}

/* Next to the busiest a flat SuperCluster counts exactly a thousandth, for any exponent. */
TEST(flat_ones_get_a_thousandth)
{
    t3r_cluster clusters[CLUSTERS + 1];
    t3r_view view = made_up_view(clusters);
    for (uint32_t k = 0; k < CLUSTERS; k++) {
        clusters[k].points = k < 2 ? 100000 : 0;
    }
    t3r_budget_settings settings = settings_of(T3R_ALLOCATE_DENSITY, 2050);
    for (settings.gamma_q8 = 256; settings.gamma_q8 <= 512; settings.gamma_q8 += 128) {
        clusters[0].texture_q4 = 0;
        clusters[1].texture_q4 = UINT16_MAX;
        t3r_allocate(&view, 1, &settings, clusters, &alone);
        assert_int_equal(clusters[0].quota, 2);
        assert_int_equal(clusters[1].quota, 2048);
    }
}

static int by_texture(const void *a, const void *b)
{
    uint32_t x = ((const t3r_cluster *)a)->texture_q4, y = ((const t3r_cluster *)b)->texture_q4;
    return (x > y) - (x < y);
}

/* The textures are permuted by the seed; empty clusters keep out, ranks and quotas follow. */
TEST(textures_are_shuffled)
{
    t3r_cluster before[CLUSTERS + 1], clusters[CLUSTERS + 1];
    t3r_view view = made_up_view(before);
    t3r_cluster_texture(&view, 1, before, CLUSTERS);
    uint32_t last[CLUSTERS] = {0}, first_came_to = 0;
    for (uint32_t seed = 0; seed < 200; seed++) {
        uint32_t moved = 0, other = 0;
        memcpy(clusters, before, sizeof clusters);
        t3r_shuffle_texture(clusters, CLUSTERS, seed);
        for (uint32_t k = 0; k < CLUSTERS; k++) {
            assert_int_equal(clusters[k].points, before[k].points);
            assert_true(clusters[k].points > 0 || clusters[k].texture_q4 == 0);
            moved += clusters[k].texture_q4 != before[k].texture_q4;
            other += clusters[k].texture_q4 != last[k];
            last[k] = clusters[k].texture_q4;
        }
        assert_true(moved > CLUSTERS / 2 && other > CLUSTERS / 2);
        first_came_to += clusters[0].texture_q4 == before[1].texture_q4;
        t3r_rank_clusters(clusters, CLUSTERS);
        for (uint32_t k = 1; k < CLUSTERS; k++) {
            assert_true(clusters[clusters[k - 1].order].texture_q4 <= clusters[clusters[k].order].texture_q4);
        }
        t3r_budget_settings settings = settings_of(seed % 2 ? T3R_ALLOCATE_DENSITY : T3R_ALLOCATE_PAPER, 1000);
        t3r_allocate(&view, 1, &settings, clusters, &alone);
        assert_int_equal(retained_of(&view), 1000);
        t3r_cluster sorted[CLUSTERS], expected[CLUSTERS];
        memcpy(sorted, clusters, sizeof sorted);
        memcpy(expected, before, sizeof expected);
        qsort(sorted, CLUSTERS, sizeof *sorted, by_texture);
        qsort(expected, CLUSTERS, sizeof *expected, by_texture);
        for (uint32_t k = 0; k < CLUSTERS; k++) {
            assert_int_equal(sorted[k].texture_q4, expected[k].texture_q4);
        }
    }
    assert_in_range(first_came_to, 1, 20); /* 200 / 37 expected */
    t3r_cluster one = {.points = 3, .texture_q4 = 5};
    t3r_shuffle_texture(&one, 1, 1);
    assert_int_equal(one.texture_q4, 5);
}

/* For any counts of the clusters, at most Z points are retained, because the scene has room for no more. */
TEST(wild_counts_stay_within_the_budget)
{
    static const uint32_t claims[] = {PIXELS, 1u << 28, UINT32_MAX};
    for (size_t c = 0; c < sizeof claims / sizeof claims[0]; c++) {
        for (int mode = T3R_ALLOCATE_CONFIGURED + 1; mode < T3R_ALLOCATE_COUNT; mode++) {
            t3r_cluster clusters[CLUSTERS + 1];
            t3r_view view = made_up_view(clusters);
            t3r_cluster_texture(&view, 1, clusters, CLUSTERS);
            t3r_rank_clusters(clusters, CLUSTERS);
            for (uint32_t k = 0; k < CLUSTERS; k++) {
                clusters[k].points = k % 5 == 4 ? clusters[k].points : claims[c];
            }
            t3r_budget_settings settings = settings_of((t3r_allocation)mode, 1000);
            t3r_allocate(&view, 1, &settings, clusters, &alone);
            assert_in_range(retained_of(&view), 0, 1000);
            uint64_t quotas = 0;
            for (uint32_t k = 0; k <= CLUSTERS; k++) {
                quotas += clusters[k].quota;
            }
            assert_in_range(quotas, 0, 1000);
        }
    }
}

TEST(an_order_is_of_all_clusters)
{
    t3r_cluster clusters[CLUSTERS + 1];
    t3r_view view = made_up_view(clusters);
    t3r_cluster_texture(&view, 1, clusters, CLUSTERS);
    t3r_rank_clusters(clusters, CLUSTERS);
    assert_true(t3r_are_ranked(clusters, CLUSTERS));
    for (uint32_t k = 0; k < CLUSTERS; k++) {
        const uint32_t order = clusters[k].order;
        clusters[k].order = CLUSTERS;
        assert_false(t3r_are_ranked(clusters, CLUSTERS));
        clusters[k].order = clusters[(k + 1) % CLUSTERS].order;
        assert_false(t3r_are_ranked(clusters, CLUSTERS));
        clusters[k].order = order;
    }
    assert_true(t3r_are_ranked(clusters, CLUSTERS));
}
