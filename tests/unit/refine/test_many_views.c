/* SPDX-License-Identifier: Apache-2.0 */
/* Builds of many views: refinement changes the scene after each group of about four, so that many views take no more
 * passes than two, and a surface is laid once at any budget. */
#include "rgbd_frame.h"
#include "sanitized_cpu.h"
#include "unit/unit.h"

#include "room/room.h"

enum { SIDE = 64, VIEWS = 12, PASSES = 3 };

static uint8_t rgb[VIEWS][SIDE * SIDE * 3], depth[VIEWS][SIDE * SIDE * 2];
static t3r_camera camera[VIEWS];

static void draw_views(void)
{
    static uint16_t depth_mm[SIDE * SIDE];
    for (uint32_t v = 0; v < VIEWS; v++) {
        room_camera(v, SIDE, SIDE, &camera[v]);
        room_frame(v, SIDE, SIDE, 1, rgb[v], depth_mm);
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            depth[v][2 * i] = (uint8_t)depth_mm[i];
            depth[v][2 * i + 1] = (uint8_t)(depth_mm[i] >> 8);
        }
    }
}

typedef struct looks {
    uint32_t calls, views, last; /* views drawn, each counted once */
} looks;

static int look(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    looks *l = user;
    assert_true(done < total);
    if (stage == T3R_STAGE_REFINE) {
        l->calls++;
        l->views += done + 1 != l->last;
        l->last = done + 1;
    }
    return 0;
}

/* Opens an arena of full speed, which the caller frees, and reconstructs the config's number of views; of the first
 * frame alone with `equal`. */
static t3r_runtime *reconstruct(const t3r_config *config, const t3r_hooks *hooks, bool equal, void **memory,
                                t3r_scene *scene)
{
    t3r_plan_info plan;
    t3r_runtime *rt;
    assert_int_equal(t3r_plan(config, &plan), T3R_OK);
    assert_int_equal(posix_memalign(memory, T3R_ARENA_ALIGN, plan.bytes), 0);
    assert_int_equal(t3r_init(&rt, *memory, plan.bytes, config), T3R_OK);
    vectors_if_sanitized(rt);
    assert_int_equal(t3r_set_hooks(rt, hooks), T3R_OK);
    for (uint32_t v = 0; v < config->views; v++) {
        const uint32_t of = equal ? 0 : v;
        t3r_frame frame = rgbd_frame(rgb[of], depth[of], SIDE, SIDE, ROOM_DEPTH_UNIT_Q40);
        assert_int_equal(t3r_add_view(rt, &frame, &camera[of]), T3R_OK);
    }
    assert_int_equal(t3r_reconstruct(rt, NULL, scene), T3R_OK);
    return rt;
}

/* Returns the PSNR of all views of the built scene, and counts the views that refinement drew. */
static double built_psnr(uint32_t views, uint32_t passes, looks *l)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, views, SIDE * SIDE * views / 20);
    config.refine = passes;
    config.fit_passes = config.fit_widths = config.rim = config.exposure = config.align = 0;
    const t3r_hooks hooks = {.user = l, .progress = look};
    void *memory;
    t3r_scene scene;
    t3r_runtime *rt = reconstruct(&config, &hooks, false, &memory, &scene);
    static uint8_t drawn[SIDE * SIDE * 3];
    const t3r_target target = {.width = SIDE, .height = SIDE, .rgb = drawn, .rgb_stride_bytes = 3 * SIDE};
    double sum = 0;
    for (uint32_t v = 0; v < views; v++) {
        assert_int_equal(t3r_render(rt, &camera[v], &target), T3R_OK);
        for (uint32_t i = 0; i < sizeof drawn; i++) {
            double d = (double)drawn[i] - rgb[v][i];
            sum += d * d;
        }
    }
    free(memory);
    return 10 * log10(255.0 * 255.0 * views * sizeof drawn / sum);
}

TEST(many_views_come_as_far_as_few)
{
    static const double least_gain[] = {4.0, 5.2, 6.3}; /* changed after all views, 7 gain 4.8 and 12 gain 5.5 dB */
    draw_views();
    for (uint32_t views = 2; views <= VIEWS; views += 5) {
        looks l = {0};
        const double before = built_psnr(views, 0, &l), after = built_psnr(views, PASSES, &l);
        print_message("%2u views: %.2f dB, refined %.2f\n", views, before, after);
        assert_int_equal(l.views, PASSES * views); /* no view is drawn more often */
        assert_true(after - before > least_gain[views / 5]);
    }
}

/* Three equal views: the budget is nearly that of one, and takes the points of one alone. With two views it takes of
 * both, as their average is worth more there. */
TEST(surfaces_of_many_views_are_laid_once)
{
    draw_views();
    for (uint32_t views = 2; views <= 3; views++) {
        t3r_config config = t3r_default_config(SIDE, SIDE, views, SIDE * SIDE * 9 / 10);
        config.refine = config.align = config.exposure = config.rim = 0;
        void *memory;
        t3r_scene scene;
        (void)reconstruct(&config, NULL, true, &memory, &scene);
        uint32_t of_first = 0;
        for (uint32_t i = 0; i < scene.count; i++) {
            of_first += scene.gaussians[i].view == 0;
        }
        assert_int_equal(scene.count, SIDE * SIDE * 9 / 10);
        print_message("%u equal views: %u of %u Gaussians of the first\n", views, of_first, scene.count);
        assert_true(views == 2 ? of_first < scene.count * 2 / 3 : of_first == scene.count);
        free(memory);
    }
}

ALL_TESTS_WITH(NULL, NULL)
