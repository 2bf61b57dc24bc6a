/* SPDX-License-Identifier: Apache-2.0 */
/* A map of a still room in which the camera goes back and forth for ever: what is known stays as it is. After the first
 * laps neither quality nor time nor the map's widths change. At night, with LONG, for 10,000 keyframes. A young map and
 * an old one take the same keyframes in turn, so that a busy machine slows both alike. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "host/cpu.h"
#include "room/room.h"
#include "test.h"
#include "trim3r.h"

enum { W = 64, H = 48, PIXELS = W * H, LAP = 70, STRIDE = 3, MOST = 20000 };

#ifdef LONG
enum { WINDOW = 5 * LAP, KEYFRAMES = 143 * LAP };
static const uint32_t caps[] = {500, 1500, 4000, 8000, 20000};
#else
enum { WINDOW = LAP, KEYFRAMES = 5 * LAP };
static const uint32_t caps[] = {1500};
#endif
enum { CAPS = sizeof caps / sizeof *caps, CAP = 1500 };

/* Means of a window of keyframes. */
typedef struct lap {
    double psnr, milliseconds, added, removed, gaussians, width;
} lap;

typedef struct walk {
    t3r_runtime *rt;
    uint8_t *arena;
} walk;

typedef struct frame {
    bool made;
    uint8_t rgb[PIXELS * 3];
    uint16_t depth[PIXELS];
} frame;

/* Returns frame `index` of the room, which is made once. */
static frame *frame_of(uint32_t index)
{
    static frame frames[2 * LAP];
    frame *f = &frames[index];
    if (!f->made) {
        room_frame(index, W, H, 1, f->rgb, f->depth);
        f->made = true;
    }
    return f;
}

static walk start(t3r_config *config)
{
    walk w = {NULL, NULL};
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(config, &plan), T3R_OK);
    w.arena = aligned_alloc(T3R_ARENA_ALIGN, (plan.bytes + T3R_ARENA_ALIGN - 1) / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN);
    assert_non_null(w.arena);
    assert_int_equal(t3r_init(&w.rt, w.arena, plan.bytes, config), T3R_OK);
    (void)t3r_set_cpu(w.rt, t3r_cpu_features());
    return w;
}

/* Returns the square error of frame `index`, drawn from the map. */
static double error_of(const walk *w, uint32_t index)
{
    static uint8_t drawn[PIXELS * 3];
    const uint8_t *rgb = frame_of(index)->rgb;
    t3r_camera camera;
    room_camera(index, W, H, &camera);
    const t3r_target target = {.width = W, .height = H, .rgb = drawn, .rgb_stride_bytes = W * 3};
    assert_int_equal(t3r_render(w->rt, &camera, &target), T3R_OK);
    double sum = 0;
    for (int i = 0; i < PIXELS * 3; i++) {
        sum += (rgb[i] - drawn[i]) * (double)(rgb[i] - drawn[i]);
    }
    return sum / (PIXELS * 3);
}

static int by_value(const void *a, const void *b)
{
    return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

static double median_width(const walk *w)
{
    static double widths[MOST];
    t3r_scene scene;
    assert_int_equal(t3r_get_scene(w->rt, &scene), T3R_OK);
    for (uint32_t i = 0; i < scene.count; i++) {
        double squares = 0;
        for (int k = 0; k < 9; k++) {
            squares += scene.gaussians[i].factor[k] * (double)scene.gaussians[i].factor[k];
        }
        widths[i] = sqrt(squares) * exp2(scene.gaussians[i].factor_exponent);
    }
    qsort(widths, scene.count, sizeof *widths, by_value);
    return widths[scene.count / 2];
}

/* Takes keyframe `i`, of one place if `still`, and adds what it did, as its part of `count` keyframes. Before it a
 * frame between it and the previous keyframe is drawn from the map. Returns the milliseconds. */
static double take_one(const walk *w, uint32_t i, uint32_t count, bool still, lap *mean)
{
    const uint32_t index = still ? 0 : i * STRIDE % LAP;
    frame *shown = frame_of(index);
    t3r_camera camera;
    room_camera(index, W, H, &camera);
    const t3r_frame captured = {.format = T3R_PIXEL_RGB24,
                                .width = W,
                                .height = H,
                                .planes = {shown->rgb},
                                .stride_bytes = {W * 3},
                                .depth = (uint8_t *)shown->depth,
                                .depth_width = W,
                                .depth_height = H,
                                .depth_stride_bytes = W * 2,
                                .depth_unit_q40 = ROOM_DEPTH_UNIT_Q40};
    if (i > 0) {
        mean->psnr += 10 * log10(255 * 255 / error_of(w, still ? 0 : index + LAP - 1)) / count;
    }
    t3r_stream_report report;
    const clock_t begin = clock();
    assert_int_equal(t3r_stream_keyframe(w->rt, &captured, &camera, &report), T3R_OK);
    const double milliseconds = (double)(clock() - begin) * 1000 / CLOCKS_PER_SEC;
    mean->milliseconds += milliseconds / count;
    mean->added += (double)report.added / count;
    mean->removed += (double)(report.removed + report.crowded) / count;
    mean->gaussians += (double)report.gaussians / count;
    return milliseconds;
}

/* Takes `count` keyframes from number `first` on, and means what they did. */
static lap take(const walk *w, uint32_t first, uint32_t count, bool still)
{
    lap mean = {0};
    for (uint32_t i = first; i < first + count; i++) {
        (void)take_one(w, i, count, still, &mean);
    }
    mean.width = median_width(w);
    return mean;
}

static void show(const char *what, const t3r_config *config, const lap *l)
{
    printf("%s, %u Gaussians, %u passes: %.2f dB, %.2f ms, %.1f added and %.1f removed a keyframe, %.0f in the map, "
           "width %.4f\n",
           what, config->gaussians, config->refine, l->psnr, l->milliseconds, l->added, l->removed, l->gaussians,
           l->width);
}

/* Compares the last window, of whole laps, with as many from keyframe 70 on: those of an old map and of a young one. */
static void stays(t3r_config config)
{
    walk young = start(&config), old = start(&config);
    (void)take(&young, 0, LAP, false);
    (void)take(&old, 0, KEYFRAMES - WINDOW, false);
    lap early = {0}, late = {0};
    double ratios[WINDOW];
    for (uint32_t i = 0; i < WINDOW; i++) {
        const double young_ms = take_one(&young, LAP + i, WINDOW, false, &early);
        ratios[i] = take_one(&old, KEYFRAMES - WINDOW + i, WINDOW, false, &late) / young_ms;
    }
    early.width = median_width(&young);
    late.width = median_width(&old);
    qsort(ratios, WINDOW, sizeof *ratios, by_value);
    show("early", &config, &early);
    show("late", &config, &late);
    printf("a keyframe of the old map takes %.2f times as long\n", ratios[WINDOW / 2]);
    assert_true(late.psnr > early.psnr - 0.1);
    assert_true(ratios[WINDOW / 2] < 1.2);
    assert_true(late.gaussians < early.gaussians * 1.1);
    assert_true(config.refine > 0 || fabs(late.width / early.width - 1) < 0.1);
    assert_true(fabs(late.added - late.removed) < 2);
    free(young.arena);
    free(old.arena);
}

static t3r_config config_of(uint32_t gaussians)
{
    t3r_config config = t3r_default_config(W, H, 4, gaussians);
    config.stream = 1;
    return config;
}

TEST(laps)
{
    for (uint32_t c = 0; c < CAPS; c++) {
        stays(config_of(caps[c]));
    }
}

TEST(laps_without_refinement)
{
    for (uint32_t c = 0; c < CAPS; c++) {
        t3r_config config = config_of(caps[c]);
        config.refine = 0;
        stays(config);
    }
}

TEST(laps_with_warm_passes)
{
    t3r_config config = config_of(CAP);
    config.warm = 1;
    stays(config);
}

TEST(laps_remembered)
{
    t3r_config config = config_of(CAP);
    config.remember = 6;
    stays(config);
}

/* A camera that stands still adds nothing, and nothing widens. */
TEST(a_still_camera)
{
    t3r_config config = config_of(CAP);
    config.refine = 0;
    walk w = start(&config);
    const lap first = take(&w, 0, 1, true);
    const lap later = take(&w, 1, 100, true);
    show("still", &config, &later);
    assert_true(later.added < 0.5 && later.removed < 0.5);
    assert_true(fabs(later.width / first.width - 1) < 0.05);
    free(w.arena);
}
