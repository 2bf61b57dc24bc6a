/* SPDX-License-Identifier: Apache-2.0 */
/* The allocation `given`: exactly the points of highest importance, the density that heads are given, and no trace for
 * the other allocations. The references sort and count. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "budget/budget.h"
#include "budget/importance.h"
#include "core/fixed.h"
#include "core/hash.h"
#include "rgbd_frame.h"
#include "state/state.h"
#include "test.h"

enum {
    W = 61, /* rows begin inside words of the mask */
    H = 45,
    PIXELS = W * H,
    VIEWS = 2,
    POINTS = VIEWS * PIXELS,
    CLUSTERS = 9,
    WORDS = (PIXELS + 31) / 32,
    GAP = 5
};

/* One worker. */
static t3r_group_count counts[T3R_MAX_CLUSTERS + 1];
static const t3r_budget_work alone = {{NULL, 1}, counts, &t3r_kernels_c};

static uint16_t texture[VIEWS][PIXELS], key[VIEWS][PIXELS];
static uint8_t label[VIEWS][PIXELS], validity[VIEWS][PIXELS];
static uint32_t mask[VIEWS][WORDS];
static uint16_t plane[VIEWS][(W + GAP) * H];

static uint16_t importance_at(uint32_t v, size_t i)
{
    return plane[v][i / W * (W + GAP) + i % W];
}

/* Labels in columns, a cluster without points, holes; few levels of importance, so that there are ties. */
static void make_up(t3r_view views[VIEWS], t3r_cluster clusters[CLUSTERS + 1], uint32_t levels)
{
    static const uint8_t known[] = {T3R_MEASURED, T3R_MEASURED | T3R_MARK_COVERED,
                                    T3R_FILLED,   T3R_MEASURED | T3R_MARK_DOUBTFUL,
                                    T3R_MEASURED, T3R_FILLED | T3R_MARK_DOUBTFUL};
    memset(clusters, 0, (CLUSTERS + 1) * sizeof *clusters);
    for (uint32_t v = 0; v < VIEWS; v++) {
        for (uint32_t i = 0; i < PIXELS; i++) {
            uint32_t noise = t3r_mix32(i * 2 + v), x = i % W, y = i / W;
            bool hole = noise % 13 == 0 || (x > 40 && y > 30) || (x < 20 && y == 9);
            label[v][i] = hole ? 255 : (uint8_t)(x / 8);
            validity[v][i] = hole ? T3R_NO_DEPTH : known[noise % 6];
            texture[v][i] = (uint16_t)noise;
            key[v][i] = (uint16_t)(noise >> 16);
            if (!hole) {
                clusters[label[v][i]].points++;
            }
        }
        for (size_t i = 0; i < (size_t)(W + GAP) * H; i++) {
            uint32_t x = (uint32_t)i % (W + GAP), y = (uint32_t)i / (W + GAP);
            /* rises to one corner, so that some windows are full and some are empty */
            plane[v][i] =
                (uint16_t)((x * x + 5 * y + t3r_mix32((uint32_t)i + 77) % 900) * levels / 5000 * (65535 / levels));
        }
        views[v] = (t3r_view){.width = W,
                              .height = H,
                              .validity = validity[v],
                              .texture = texture[v],
                              .key = key[v],
                              .label = label[v],
                              .mask = mask[v]};
    }
}

static t3r_budget_settings settings_of(uint32_t gaussians)
{
    return (t3r_budget_settings){.allocate = T3R_ALLOCATE_GIVEN,
                                 .gaussians = gaussians,
                                 .keep_percent = 10,
                                 .gamma_q8 = 179,
                                 .clusters = CLUSTERS,
                                 .seed = 1,
                                 .pass_over_covered = false};
}

/* ---- chosen points ----------------------------------------------------------------------------------------------- */

typedef struct point {
    uint32_t importance, order; /* order: view after view, row after row */
} point;

static int by_importance(const void *a, const void *b)
{
    const point *x = a, *y = b;
    if (x->importance != y->importance) {
        return x->importance > y->importance ? -1 : 1;
    }
    return (x->order > y->order) - (x->order < y->order);
}

static uint32_t sorted_points(point points[POINTS])
{
    uint32_t valid = 0;
    for (uint32_t n = 0; n < POINTS; n++) {
        if (t3r_has_depth(validity[n / PIXELS][n % PIXELS])) {
            points[valid++] = (point){importance_at(n / PIXELS, n % PIXELS), n};
        }
    }
    qsort(points, valid, sizeof *points, by_importance);
    return valid;
}

TEST(the_highest_are_retained)
{
    static point points[POINTS];
    t3r_view views[VIEWS];
    t3r_cluster clusters[CLUSTERS + 1];
    const uint16_t *const planes[VIEWS] = {plane[0], plane[1]};
    const t3r_importance importance = {planes, sizeof(uint16_t) * (W + GAP)};
    const uint32_t levels[] = {1, 2, 40, 65535};
    for (size_t l = 0; l < sizeof levels / sizeof *levels; l++) {
        make_up(views, clusters, levels[l]);
        const uint32_t valid = sorted_points(points);
        const uint32_t budgets[] = {1, 2, 100, valid / 10, valid / 2, valid - 1, valid, valid + 1, 1u << 24};
        for (size_t b = 0; b < sizeof budgets / sizeof *budgets; b++) {
            t3r_budget_settings settings = settings_of(budgets[b]);
            t3r_importance_keys(views, VIEWS, &importance);
            t3r_allocate(views, VIEWS, &settings, clusters, &alone);
            static uint8_t expected[POINTS];
            memset(expected, 0, sizeof expected);
            for (uint32_t n = 0; n < T3R_MIN(budgets[b], valid); n++) {
                expected[points[n].order] = 1;
            }
            for (uint32_t n = 0; n < POINTS; n++) {
                assert_int_equal(t3r_retained(&views[n / PIXELS], n % PIXELS), expected[n]);
                assert_false(t3r_is_deferred(&views[n / PIXELS], n % PIXELS, &settings));
            }
        }
    }
}

/* ---- density ----------------------------------------------------------------------------------------------------- */

static double log_share(uint32_t retained, uint32_t valid)
{
    double log_q10 = retained == 0 ? -1e9 : log2((double)retained / valid) * 1024;
    return log_q10 < T3R_LEAST_DENSITY_Q10 ? T3R_LEAST_DENSITY_Q10 : log_q10;
}

/* Returns the share of the 9 x 9 pixels around one that are within the picture. */
static double window_share(const t3r_view *view, int x, int y)
{
    uint32_t retained = 0, valid = 0;
    for (int j = y - 4; j <= y + 4; j++) {
        for (int i = x - 4; i <= x + 4; i++) {
            if (i >= 0 && j >= 0 && i < W && j < H && t3r_has_depth(view->validity[j * W + i])) {
                valid++;
                retained += view->mask[(j * W + i) / 32] >> ((j * W + i) % 32) & 1;
            }
        }
    }
    return log_share(retained, valid);
}

TEST(density_is_counted)
{
    t3r_view views[VIEWS];
    t3r_cluster clusters[CLUSTERS + 1];
    const uint16_t *const planes[VIEWS] = {plane[0], plane[1]};
    const t3r_importance importance = {planes, sizeof(uint16_t) * (W + GAP)};
    make_up(views, clusters, 65535);
    uint32_t by_window = 0, by_cluster = 0, between = 0, least = 0;
    for (uint32_t budget = 3; budget < POINTS; budget *= 3) {
        t3r_budget_settings settings = settings_of(budget);
        t3r_importance_keys(views, VIEWS, &importance);
        t3r_allocate(views, VIEWS, &settings, clusters, &alone);
        uint32_t retained[CLUSTERS] = {0}, points[CLUSTERS] = {0};
        for (uint32_t n = 0; n < POINTS; n++) {
            if (t3r_has_depth(validity[n / PIXELS][n % PIXELS])) {
                const uint32_t k = label[n / PIXELS][n % PIXELS];
                points[k]++;
                retained[k] += t3r_retained(&views[n / PIXELS], n % PIXELS);
            }
        }
        for (uint32_t n = 0; n < POINTS; n++) {
            const t3r_view *view = &views[n / PIXELS];
            const uint32_t i = n % PIXELS, k = view->label[i];
            const int32_t told = t3r_log_density_q10(view, i, &settings, clusters);
            if (!t3r_has_depth(view->validity[i])) {
                assert_int_equal(told, 0);
                continue;
            }
            /* the window's share up to half an octave above the SuperCluster's; from an octave on, the SuperCluster's
             */
            const double window = window_share(view, (int)(i % W), (int)(i / W));
            const double more = window - log_share(retained[k], points[k]);
            const double expected = more <= 512 ? window : more >= 1024 ? window - more : window - 2 * (more - 512);
            if (fabs(told - expected) > 2) { /* three times the error of two logarithms and a rounding */
                fail_msg("budget %u, pixel %u: told %d, counted %.2f", budget, n, told, expected);
            }
            by_window += more <= 512;
            by_cluster += more >= 1024;
            between += more > 512 && more < 1024;
            least += told == T3R_LEAST_DENSITY_Q10;
        }
    }
    assert_true(by_window > 1000 && by_cluster > 300 && between > 300 && least > 1000);
}

/* ---- through the interface --------------------------------------------------------------------------------------- */

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[1 << 20], copy[1 << 20];
static size_t arena_bytes;
static int cancel_at = -1;

static int cancel(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    (void)user;
    (void)done;
    (void)total;
    return (int)stage == cancel_at;
}

static t3r_runtime *with_views(const t3r_config *config)
{
    static uint8_t colour[PIXELS * 3], depth[PIXELS * 2];
    t3r_plan_info plan;
    t3r_runtime *rt;
    assert_int_equal(t3r_plan(config, &plan), T3R_OK);
    assert_true(plan.bytes <= sizeof arena);
    arena_bytes = plan.bytes;
    cancel_at = -1;
    assert_int_equal(t3r_init(&rt, arena, arena_bytes, config), T3R_OK);
    for (uint32_t v = 0; v < VIEWS; v++) {
        for (uint32_t i = 0; i < PIXELS; i++) {
            uint32_t noise = t3r_mix32(i + 9 * v), step = noise % 17 == 0 ? 0 : 1500 + i % W * 3;
            colour[3 * i] = (uint8_t)noise;
            colour[3 * i + 1] = (uint8_t)(i / W * 4);
            colour[3 * i + 2] = (uint8_t)(noise >> 8);
            depth[2 * i] = (uint8_t)step;
            depth[2 * i + 1] = (uint8_t)(step >> 8);
        }
        t3r_frame frame = rgbd_frame(colour, depth, W, H, MILLIMETRE_Q40);
        t3r_camera camera = {.fx_q16 = W << 16,
                             .fy_q16 = W << 16,
                             .cx_q16 = W << 15,
                             .cy_q16 = H << 15,
                             .position_q32 = {(int64_t)v << 27},
                             .rotation_q30 = {1 << 30}};
        assert_int_equal(t3r_add_view(rt, &frame, &camera), T3R_OK);
    }
    t3r_hooks hooks = {.progress = cancel};
    assert_int_equal(t3r_set_hooks(rt, &hooks), T3R_OK);
    return rt;
}

static t3r_config config_of(t3r_allocation allocation)
{
    t3r_config config = t3r_default_config(W, H, VIEWS, 900);
    config.rim = 0;
    config.clusters = 12;
    config.allocate = allocation;
    config.keep_analysis = 1;
    return config;
}

static uint64_t hash_of(const t3r_scene *scene)
{
    return t3r_hash_bytes(T3R_HASH_START, (const uint8_t *)scene->gaussians, scene->count * sizeof *scene->gaussians);
}

/* The runtime's own planes: the same reference as above. */
static void expect_highest(const t3r_runtime *rt, const t3r_scene *scene, uint32_t budget)
{
    static point points[POINTS];
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    for (uint32_t v = 0; v < VIEWS; v++) {
        memcpy(validity[v], views[v].validity, sizeof validity[v]);
    }
    const uint32_t valid = sorted_points(points);
    assert_true(scene->valid_points < valid); /* some were filled: they compete, but add no budget */
    assert_int_equal(scene->count, T3R_MIN(budget, scene->valid_points));
    for (uint32_t n = 0; n < valid; n++) {
        const uint32_t at = points[n].order;
        assert_int_equal(t3r_retained(&views[at / PIXELS], at % PIXELS), n < scene->count);
    }
}

TEST(nothing_stays_behind)
{
    t3r_view made_up[VIEWS];
    t3r_cluster clusters[CLUSTERS + 1];
    make_up(made_up, clusters, 40);
    const uint16_t *const planes[VIEWS] = {plane[0], plane[1]};
    const uint32_t stride = sizeof(uint16_t) * (W + GAP);
    const t3r_request given = {.gaussians = 400, .importance = planes, .importance_stride_bytes = stride};
    for (uint32_t unadapted = 0; unadapted < 2; unadapted++) {
        t3r_config config = config_of(T3R_ALLOCATE_DENSITY);
        t3r_scene scene;
        t3r_runtime *rt = with_views(&config);
        assert_int_equal(t3r_set_ablation(rt, &(t3r_ablation){.unadapted = unadapted}), T3R_OK);
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
        const uint64_t before = hash_of(&scene);
        assert_int_equal(t3r_rebuild(rt, &given, &scene), T3R_OK);
        expect_highest(rt, &scene, 400);
        const uint64_t chosen = hash_of(&scene);
        assert_int_equal(t3r_rebuild(rt, NULL, &scene), T3R_OK);
        assert_true(hash_of(&scene) == before);

        /* after a cancel, the following builds are as before */
        for (cancel_at = T3R_STAGE_BUDGET; cancel_at <= T3R_STAGE_REFINE; cancel_at++) {
            assert_int_equal(t3r_rebuild(rt, &given, &scene), T3R_ERR_CANCELLED);
            assert_int_equal(t3r_get_scene(rt, &scene), T3R_ERR_STATE);
        }
        cancel_at = -1;
        assert_int_equal(t3r_rebuild(rt, NULL, &scene), T3R_OK);
        assert_true(hash_of(&scene) == before);

        /* without a kept analysis, in an arena planned for the allocation or not, and moved in between */
        for (int told = 0; told < 2; told++) {
            config.gaussians = config.max_gaussians = 400;
            config.keep_analysis = 0;
            config.allocate = told ? T3R_ALLOCATE_GIVEN : T3R_ALLOCATE_DENSITY;
            rt = with_views(&config);
            memcpy(copy, arena, arena_bytes);
            assert_int_equal(t3r_attach(&rt, copy, arena_bytes), T3R_OK);
            assert_int_equal(t3r_reconstruct(rt, NULL, &scene), told ? T3R_ERR_STATE : T3R_OK);
            assert_int_equal(t3r_attach(&rt, copy, arena_bytes), T3R_OK);
            assert_int_equal(t3r_reset(rt), T3R_OK);
            rt = with_views(&config);
            assert_int_equal(t3r_set_ablation(rt, &(t3r_ablation){.unadapted = unadapted}), T3R_OK);
            assert_int_equal(t3r_reconstruct(rt, &given, &scene), T3R_OK);
            assert_true(hash_of(&scene) == chosen);
            memcpy(copy, arena, arena_bytes);
            assert_int_equal(t3r_attach(&rt, copy, arena_bytes), T3R_OK);
            assert_int_equal(t3r_get_scene(rt, &scene), T3R_OK);
            assert_true(hash_of(&scene) == chosen);
            assert_int_equal(t3r_rebuild(rt, &given, &scene), T3R_ERR_STATE);
            assert_int_equal(t3r_reconstruct(rt, NULL, &scene), told ? T3R_ERR_STATE : T3R_OK);
        }
    }
}

/* A copy of a kept analysis continues with new importances, for any contents of its masks. */
TEST(a_copy_goes_on)
{
    t3r_view made_up[VIEWS];
    t3r_cluster clusters[CLUSTERS + 1];
    make_up(made_up, clusters, 65535);
    const uint16_t *const planes[VIEWS] = {plane[0], plane[1]};
    const t3r_request given = {.importance = planes, .importance_stride_bytes = sizeof(uint16_t) * (W + GAP)};
    t3r_config config = config_of(T3R_ALLOCATE_GIVEN);
    t3r_scene scene;
    t3r_runtime *rt = with_views(&config);
    assert_int_equal(t3r_reconstruct(rt, &given, &scene), T3R_OK);
    expect_highest(rt, &scene, 900);
    const uint64_t before = hash_of(&scene);
    memcpy(copy, arena, arena_bytes);
    assert_int_equal(t3r_attach(&rt, copy, arena_bytes), T3R_OK);
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    memset(views[0].mask, 0xa5, WORDS * sizeof(uint32_t));
    assert_int_equal(t3r_rebuild(rt, NULL, &scene), T3R_ERR_STATE); /* `given` applies only with the request */
    assert_int_equal(t3r_rebuild(rt, &given, &scene), T3R_OK);
    assert_true(hash_of(&scene) == before);
}
