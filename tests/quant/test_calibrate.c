/* SPDX-License-Identifier: Apache-2.0 */
/* Calibration: maxima and percentiles against a sort, and views of a runtime. */
#include "calibrate.h"
#include "rgbd_frame.h"

#include "budget/budget.h"
#include "head/head_features.h"
#include "sample_head.h"
#include "state/state.h"
#include "trim3r_heads.h"
#include "unit/unit.h"

enum { WIDTH = 40, HEIGHT = 30, PIXELS = WIDTH * HEIGHT, VIEWS = 3 };

typedef struct sample_views {
    int8_t features[VIEWS][PIXELS * T3R_FEATURES];
    uint8_t retained[VIEWS][PIXELS];
} sample_views;

static void fill(sample_views *views)
{
    uint64_t seed = 5;
    for (int v = 0; v < VIEWS; v++) {
        for (int i = 0; i < PIXELS * T3R_FEATURES; i++) {
            views->features[v][i] = (int8_t)unit_between(&seed, -128, 127);
        }
        for (int i = 0; i < PIXELS; i++) {
            views->retained[v][i] = unit_between(&seed, 0, 3) == 0;
        }
    }
}

static void forget_ranges(float_head *head, uint32_t but)
{
    for (uint32_t i = 0; i < head->graph.count; i++) {
        if (i + 1 != but) {
            free(head->layers[i].range);
            head->layers[i].range = NULL;
        }
    }
}

static int by_size(const void *left, const void *right)
{
    float a = *(const float *)left, b = *(const float *)right;
    return (a > b) - (a < b);
}

/* Returns all values of a channel over the views, sorted by magnitude; for a point layer those at retained pixels. */
static float *sorted(const float_head *head, const sample_views *views, uint32_t n, uint32_t channel, size_t *count)
{
    float *all = unit_array(VIEWS * PIXELS, sizeof *all);
    *count = 0;
    for (int v = 0; v < VIEWS; v++) {
        float_planes planes;
        assert_int_equal(float_run(&planes, head, views->features[v], views->retained[v], WIDTH, HEIGHT), 0);
        const float_plane *plane = &planes.planes[n];
        bool point = head->graph.layers[n - 1].kind == T3R_LAYER_POINT;
        for (size_t i = 0; i < (size_t)plane->width * plane->height; i++) {
            if (!point || views->retained[v][i]) {
                all[(*count)++] = fabsf(plane->values[i * plane->channels + channel]);
            }
        }
        float_planes_free(&planes);
    }
    qsort(all, *count, sizeof *all, by_size);
    return all;
}

TEST(test_ranges)
{
    static const double percentiles[] = {100, 99.99, 99, 50};
    sample_views *views = unit_array(1, sizeof *views);
    fill(views);
    for (size_t p = 0; p < sizeof percentiles / sizeof *percentiles; p++) {
        float_head head;
        sample_head(&head, 2);
        forget_ranges(&head, 0);
        calibration *c = calibration_start(&head);
        assert_non_null(c);
        for (int v = 0; v < VIEWS; v++) {
            assert_int_equal(calibration_add(c, views->features[v], views->retained[v], WIDTH, HEIGHT), 0);
        }
        assert_int_equal(calibration_pixels(c), VIEWS * PIXELS);
        assert_int_equal(calibration_finish(c, &head, percentiles[p], 2), 5);
        assert_null(head.layers[5].range);
        for (uint32_t n = 1; n < head.graph.count; n++) {
            for (uint32_t o = 0; o < head.graph.layers[n - 1].outputs; o++) {
                size_t count;
                float *all = sorted(&head, views, n, o, &count);
                size_t at = (size_t)ceil(percentiles[p] / 100 * (double)count);
                float exact = all[at == 0 ? 0 : at - 1], most = all[count - 1], got = head.layers[n - 1].range[o] / 2;
                if (exact > 0) {
                    assert_true(got >= exact && (got <= exact * (1 + 1.0f / 64) || (most <= 0 && got > 0)));
                }
                if (percentiles[p] >= 100 && most > 0) {
                    assert_true(got >= most && got <= most);
                }
                assert_true(got > 0);
                free(all);
            }
        }
        calibration_free(c);
        float_head_free(&head);
    }
    free(views);
}

/* A head's own ranges are kept; without a pixel there are none. */
TEST(test_own_ranges)
{
    sample_views *views = unit_array(1, sizeof *views);
    fill(views);
    float_head head;
    sample_head(&head, 2);
    forget_ranges(&head, 3);
    float before = head.layers[2].range[4];
    calibration *c = calibration_start(&head);
    assert_int_equal(calibration_finish(c, &head, 100, 1), -1);
    forget_ranges(&head, 3);
    assert_int_equal(calibration_add(c, views->features[0], views->retained[0], WIDTH, HEIGHT), 0);
    assert_int_equal(calibration_finish(c, &head, 100, 1), 4);
    assert_true(head.layers[2].range[4] >= before && head.layers[2].range[4] <= before);
    assert_int_equal(calibration_finish(c, &head, 100, 1), 0);
    calibration_free(c);
    float_head_free(&head);
    free(views);
}

/* A channel that is always 0 gets the layer's largest range. */
TEST(test_dead_channel)
{
    sample_views *views = unit_array(1, sizeof *views);
    fill(views);
    float_head head;
    sample_head(&head, 2);
    forget_ranges(&head, 0);
    const head_layer *layer = &head.graph.layers[0];
    for (uint32_t t = 0; t < head_taps(layer); t++) {
        for (uint32_t i = 0; i < layer->inputs; i++) {
            head.layers[0].weight[head_weight_index(layer, 3, i, t)] = 0;
        }
    }
    head.layers[0].bias[3] = -1;
    calibration *c = calibration_start(&head);
    assert_int_equal(calibration_add(c, views->features[0], views->retained[0], WIDTH, HEIGHT), 0);
    assert_int_equal(calibration_finish(c, &head, 100, 1), 5);
    float largest = 0;
    for (uint32_t o = 0; o < layer->outputs; o++) {
        largest = o == 3 ? largest : fmaxf(largest, head.layers[0].range[o]);
    }
    assert_true(largest > 0 && head.layers[0].range[3] >= largest && head.layers[0].range[3] <= largest);
    calibration_free(c);
    float_head_free(&head);
    free(views);
}

/* A head whose first layer passes the features on: its ranges are the features' own. */
TEST(test_runtime_views)
{
    enum { SIDE = 16, BUDGET = 60 };
    float_head head = {.graph = {.name = "identity",
                                 .count = 2,
                                 .layers = {{T3R_LAYER_CONV, 0, {0, T3R_SOURCE_NONE}, 9, 9, 1, 1, 1, false},
                                            {T3R_LAYER_POINT, 0, {1, T3R_SOURCE_NONE}, 9, 9, 1, 1, 1, false}}}};
    for (int n = 0; n < 2; n++) {
        head.layers[n].weight = unit_array(81, sizeof(float));
        head.layers[n].bias = unit_array(9, sizeof(float));
        for (int i = 0; i < 9; i++) {
            head.layers[n].weight[i * 10] = 1;
        }
    }
    uint8_t colour[SIDE][SIDE][3], depth[SIDE][SIDE][2];
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            colour[y][x][0] = x < 8 ? 200 : 100; /* 72, -28 */
            colour[y][x][1] = 128;               /* 0 */
            colour[y][x][2] = 28;                /* -100 */
            depth[y][x][0] = 2000 & 255;
            depth[y][x][1] = 2000 >> 8;
        }
    }
    t3r_frame frame = rgbd_frame(&colour[0][0][0], &depth[0][0][0], SIDE, SIDE, MILLIMETRE_Q40);
    t3r_camera camera = {.fx_q16 = SIDE << 16,
                         .fy_q16 = SIDE << 16,
                         .cx_q16 = (SIDE - 1) << 15,
                         .cy_q16 = (SIDE - 1) << 15,
                         .rotation_q30 = {1 << 30}};
    for (uint32_t keep = 0; keep < 2; keep++) {
        t3r_config config = t3r_default_config(SIDE, SIDE, 1, BUDGET);
        config.keep_analysis = keep;
        t3r_plan_info plan;
        assert_int_equal(t3r_plan(&config, &plan), T3R_OK);
        void *arena = NULL;
        assert_int_equal(posix_memalign(&arena, T3R_ARENA_ALIGN, plan.bytes), 0);
        t3r_runtime *runtime;
        t3r_scene scene;
        assert_int_equal(t3r_init(&runtime, arena, plan.bytes, &config), T3R_OK);
        assert_int_equal(t3r_add_view(runtime, &frame, &camera), T3R_OK);
        calibration *c = calibration_start(&head);
        assert_int_equal(calibration_add_views(c, runtime), -1);
        assert_int_equal(t3r_reconstruct(runtime, NULL, &scene), T3R_OK);
        if (!keep) {
            assert_int_equal(calibration_add_views(c, runtime), -1);
        } else {
            assert_int_equal(calibration_add_views(c, runtime), 0);
            assert_int_equal(t3r_rebuild(runtime, &(t3r_request){.gaussians = BUDGET / 4}, &scene), T3R_OK);
            assert_int_equal(calibration_add_views(c, runtime), 0);
            assert_int_equal(calibration_pixels(c), 2 * SIDE * SIDE);
            assert_int_equal(calibration_finish(c, &head, 100, 1), 1);
            const float *range = head.layers[0].range;
            assert_true(range[0] * 64 == 72 && range[2] * 64 == 100 && range[3] * 64 == 127 && range[4] * 64 == 127);
            /* green was always 0, so its range is the maximum */
            assert_true(range[1] * 64 == 127 && range[7] * 64 == 127);
        }
        calibration_free(c);
        free(arena);
    }
    float_head_free(&head);
}

/* Two cameras a quarter of the picture apart, in front of one slanted surface. */
enum { PAIR = 2, PAIR_SIDE = 64, PAIR_PIXELS = PAIR_SIDE * PAIR_SIDE, ROW = PAIR_SIDE * T3R_FEATURES };

/* The computed rows of features, in the order of views, during one call. */
typedef struct taken {
    uint32_t rows;
    int8_t features[PAIR * PAIR_SIDE][ROW];
} taken;

static taken *taking;

/* The linker replaces every call of t3r_head_features() from another file by this: the head's and the calibration's. */
void __real_t3r_head_features(const t3r_head_input *input, uint32_t y, int8_t *row);
void __wrap_t3r_head_features(const t3r_head_input *input, uint32_t y, int8_t *row);
void __wrap_t3r_head_features(const t3r_head_input *input, uint32_t y, int8_t *row)
{
    __real_t3r_head_features(input, y, row);
    if (taking != NULL) {
        assert_int_equal(taking->rows, input->view_index * PAIR_SIDE + y);
        memcpy(taking->features[taking->rows++], row, ROW);
    }
}

static void add_pair(t3r_runtime *runtime)
{
    static uint8_t colour[PAIR_PIXELS * 3], depth[PAIR_PIXELS * 2];
    for (int v = 0; v < PAIR; v++) {
        for (int i = 0; i < PAIR_PIXELS; i++) {
            int x = i % PAIR_SIDE + 16 * v, y = i / PAIR_SIDE;
            uint32_t steps = 2000 + 4 * (uint32_t)y;
            colour[3 * i] = (uint8_t)(128 + (x * 13 + y * 7) % 90);
            colour[3 * i + 1] = (uint8_t)(60 + 2 * x);
            colour[3 * i + 2] = (uint8_t)(y * 3);
            depth[2 * i] = (uint8_t)steps;
            depth[2 * i + 1] = (uint8_t)(steps >> 8);
        }
        t3r_frame frame = rgbd_frame(colour, depth, PAIR_SIDE, PAIR_SIDE, MILLIMETRE_Q40);
        t3r_camera camera = {.fx_q16 = PAIR_SIDE << 16,
                             .fy_q16 = PAIR_SIDE << 16,
                             .cx_q16 = (PAIR_SIDE - 1) << 15,
                             .cy_q16 = (PAIR_SIDE - 1) << 15,
                             .position_q32 = {(int64_t)v << 31},
                             .rotation_q30 = {1 << 30}};
        assert_int_equal(t3r_add_view(runtime, &frame, &camera), T3R_OK);
    }
}

/* Calibration gets the network's features: with 5 % kept, when points that another view covers are passed over, and
 * with 60 %, when they are not; with the mask shown and hidden. */
TEST(test_features_of_a_pair)
{
    static taken network, calibrated;
    for (uint32_t unadapted = 0; unadapted < 2; unadapted++) {
        t3r_config config = t3r_default_config(PAIR_SIDE, PAIR_SIDE, PAIR, PAIR * PAIR_PIXELS);
        config.head = T3R_HEAD_LEARNED;
        config.keep_analysis = 1;
        config.refine = 0;
        t3r_plan_info plan;
        assert_int_equal(t3r_plan(&config, &plan), T3R_OK);
        void *arena = NULL;
        assert_int_equal(posix_memalign(&arena, T3R_ARENA_ALIGN, plan.bytes), 0);
        t3r_runtime *runtime;
        t3r_scene scene;
        float_head head;
        sample_head(&head, 2);
        forget_ranges(&head, 0);
        calibration *c = calibration_start(&head);
        assert_non_null(c);
        assert_int_equal(t3r_init(&runtime, arena, plan.bytes, &config), T3R_OK);
        assert_int_equal(t3r_set_ablation(runtime, &(t3r_ablation){.unadapted = unadapted}), T3R_OK);
        assert_int_equal(t3r_bind_head(runtime, t3r_head_tiny, t3r_head_tiny_bytes), T3R_OK);
        add_pair(runtime);
        assert_int_equal(t3r_reconstruct(runtime, NULL, &scene), T3R_OK);
        t3r_view views[T3R_MAX_VIEWS];
        t3r_views_of(runtime, views);
        uint32_t covered = 0;
        for (int v = 0; v < PAIR; v++) {
            for (int i = 0; i < PAIR_PIXELS; i++) {
                covered += t3r_is_covered(views[v].validity[i]);
            }
        }
        assert_true(covered > PAIR_PIXELS / 2);
        static const uint32_t percent[] = {5, 60};
        for (size_t k = 0; k < sizeof percent / sizeof *percent; k++) {
            network.rows = calibrated.rows = 0;
            taking = &network;
            const t3r_request fewer = {.gaussians = PAIR * PAIR_PIXELS * percent[k] / 100};
            assert_int_equal(t3r_rebuild(runtime, &fewer, &scene), T3R_OK);
            taking = &calibrated;
            assert_int_equal(calibration_add_views(c, runtime), 0);
            taking = NULL;
            assert_int_equal(network.rows, PAIR * PAIR_SIDE);
            assert_int_equal(calibrated.rows, PAIR * PAIR_SIDE);
            assert_memory_equal(network.features, calibrated.features, sizeof network.features);
        }
        calibration_free(c);
        float_head_free(&head);
        free(arena);
    }
}
