/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes that are made to be slow: faint Gaussians as wide as the picture, so that every tile lists them all and
 * nothing ends early. The plan bounds what is blended, tile_splats bounds it further, and a caller can stop within a
 * tile. */
#include <stdlib.h>
#include <string.h>

#include "oracle/float64/drawing.h"
#include "raster/raster_tile.h"
#include "state/state.h"
#include "test.h"

enum { LONG = 70000, SHORT = 500, SIDE = 48 }; /* LONG: more than are blended between two looks at the hook */

static const t3r_scene_frame plain_frame;

/* Layers of haze, the nearest first and each of its own colour. */
static t3r_gaussian *haze(uint32_t count)
{
    t3r_gaussian *all = calloc(count, sizeof *all);
    assert_non_null(all);
    for (uint32_t i = 0; i < count; i++) {
        all[i] = round_gaussian(0, 0, 1 + (double)i / count, 40, 0.006, i % 3 == 0, i % 5 / 4.0, i % 7 / 6.0);
    }
    return all;
}

typedef struct bench {
    arena memory;
    t3r_config config;
    t3r_runtime *rt;
} bench;

static bench bench_of(const t3r_gaussian *gaussians, uint32_t count, uint32_t side, uint32_t tile_splats)
{
    bench b = {.config = render_config(count, side, side)};
    b.config.tile_splats = tile_splats;
    b.memory = arena_of(&b.config, ARENA_AT_FULL);
    assert_int_equal(t3r_init(&b.rt, b.memory.bytes, b.memory.count, &b.config), T3R_OK);
    load_scene(b.rt, &plain_frame, gaussians, count);
    return b;
}

/* --- how much is blended ------------------------------------------------------------------------- */

static uint64_t blended;

static void count_blends(t3r_tile *tile, const t3r_tile_splat *splat)
{
    blended++;
    t3r_blend_c(tile, splat);
}

static uint64_t blends_of(const t3r_gaussian *gaussians, uint32_t count, uint32_t tile_splats, uint64_t *planned)
{
    bench b = bench_of(gaussians, count, SIDE, tile_splats);
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(&b.config, &plan), T3R_OK);
    *planned = plan.most_blends;
    blended = 0;
    b.rt->kernels.blend = count_blends;
    const t3r_camera camera = plain_camera(SIDE, SIDE, SIDE);
    drawing d = draw(b.rt, &camera, SIDE, SIDE);
    drawing_free(&d);
    arena_free(&b.memory);
    return blended;
}

TEST(the_plan_bounds_what_is_blended)
{
    t3r_gaussian *gaussians = haze(SHORT);
    static const uint32_t limits[] = {0, 1, 37, SHORT, T3R_MAX_GAUSSIANS};
    for (size_t i = 0; i < sizeof limits / sizeof limits[0]; i++) {
        uint64_t planned, count = blends_of(gaussians, SHORT, limits[i], &planned);
        assert_int_equal(planned, 9 * (limits[i] == 1 || limits[i] == 37 ? limits[i] : SHORT));
        assert_int_equal(count, planned); /* haze reaches the bound */
    }
    free(gaussians);
}

/* --- which are drawn ------------------------------------------------------------------------------ */

static drawing drawing_of(const t3r_gaussian *gaussians, uint32_t count, uint32_t tile_splats)
{
    bench b = bench_of(gaussians, count, SIDE, tile_splats);
    const t3r_camera camera = plain_camera(SIDE, SIDE, SIDE);
    drawing d = draw(b.rt, &camera, SIDE, SIDE);
    arena_free(&b.memory);
    return d;
}

TEST(the_nearest_are_drawn)
{
    t3r_gaussian *gaussians = haze(SHORT);
    drawing whole = drawing_of(gaussians, SHORT, 0);
    static const uint32_t limits[] = {1, 40, SHORT - 1, SHORT, SHORT + 1};
    for (size_t i = 0; i < sizeof limits / sizeof limits[0]; i++) {
        /* the scene is in depth order, and every tile lists it all */
        drawing limited = drawing_of(gaussians, SHORT, limits[i]);
        drawing nearest = drawing_of(gaussians, limits[i] < SHORT ? limits[i] : SHORT, 0);
        assert_true(drawing_equal(&limited, &nearest));
        assert_true(drawing_equal(&limited, &whole) == (limits[i] >= SHORT));
        drawing_free(&limited);
        drawing_free(&nearest);
    }
    drawing_free(&whole);
    free(gaussians);
}

/* --- stopping ------------------------------------------------------------------------------------- */

typedef struct watch {
    uint32_t looks, stop_at; /* 0: never */
} watch;

static int look(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    watch *w = user;
    assert_int_equal(stage, T3R_STAGE_RASTER);
    assert_true(done <= total);
    return ++w->looks == w->stop_at;
}

static void draw_at_once(const t3r_gaussian *gaussians, uint32_t count, const t3r_camera *camera, uint8_t *rgb)
{
    t3r_projection projection;
    assert_int_equal(t3r_projection_make(camera, &plain_frame, 16, 16, &projection), T3R_OK);
    t3r_splat *splats = calloc(count, sizeof *splats);
    uint32_t *list = calloc(count, sizeof *list);
    assert_true(splats != NULL && list != NULL);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(t3r_project(&projection, &gaussians[i], &splats[i]));
        list[i] = i;
    }
    const t3r_target target = {.width = 16, .height = 16, .rgb = rgb, .rgb_stride_bytes = 16 * 3};
    t3r_drawn_tile tile;
    t3r_draw_begin(&tile, 0, 0);
    const t3r_binning bin = {
        .kernels = &t3r_kernels_c, .projection = &projection, .gaussians = gaussians, .splats = splats};
    t3r_draw_list(&tile, &bin, list, count, &target);
    t3r_draw_end(&tile, &target);
    free(list);
    free(splats);
}

/* One tile whose list is longer than what is blended between two looks. */
TEST(a_long_list_can_be_stopped)
{
    t3r_gaussian *gaussians = haze(LONG);
    const t3r_camera camera = plain_camera(16, 16, 16);
    uint8_t rgb[16 * 16 * 3] = {0};
    const t3r_target target = {.width = 16, .height = 16, .rgb = rgb, .rgb_stride_bytes = 16 * 3};
    for (uint32_t stop_at = 0; stop_at < 4; stop_at++) {
        bench b = bench_of(gaussians, LONG, 16, 0);
        watch w = {.stop_at = stop_at};
        const t3r_hooks hooks = {.user = &w, .progress = look};
        assert_int_equal(t3r_set_hooks(b.rt, &hooks), T3R_OK);
        assert_int_equal(t3r_render(b.rt, &camera, &target), stop_at == 0 ? T3R_OK : T3R_ERR_CANCELLED);
        assert_int_equal(w.looks, stop_at == 0 ? 3 : stop_at); /* before all, before the tile, within it */
        arena_free(&b.memory);
    }
    /* part after part is the picture that the whole list gives at once */
    uint8_t at_once[sizeof rgb] = {0};
    draw_at_once(gaussians, LONG, &camera, at_once);
    assert_memory_equal(rgb, at_once, sizeof rgb); /* renders that were stopped left it alone */
    free(gaussians);
}

/* Behind what is opaque nothing of the list is drawn, and nobody is asked. */
TEST(a_long_list_ends_where_nothing_shows)
{
    t3r_gaussian *gaussians = haze(LONG);
    for (uint32_t i = 0; i < LONG; i++) {
        gaussians[i].opacity_q15 = i < 100 ? 32767 : gaussians[i].opacity_q15;
    }
    const t3r_camera camera = plain_camera(16, 16, 16);
    uint8_t rgb[16 * 16 * 3] = {0}, nearest[sizeof rgb] = {0};
    const t3r_target target = {.width = 16, .height = 16, .rgb = rgb, .rgb_stride_bytes = 16 * 3};
    bench b = bench_of(gaussians, LONG, 16, 0);
    watch w = {0};
    const t3r_hooks hooks = {.user = &w, .progress = look};
    assert_int_equal(t3r_set_hooks(b.rt, &hooks), T3R_OK);
    assert_int_equal(t3r_render(b.rt, &camera, &target), T3R_OK);
    assert_int_equal(w.looks, 2); /* before all, before the tile */
    draw_at_once(gaussians, 100, &camera, nearest);
    assert_memory_equal(rgb, nearest, sizeof rgb);
    arena_free(&b.memory);
    free(gaussians);
}

/* Between two looks at most 65,536 splats are blended, or a tile. */
TEST(many_lists_are_looked_after)
{
    enum { COUNT = 5000 };
    t3r_gaussian *gaussians = haze(COUNT);
    bench b = bench_of(gaussians, COUNT, SIDE * 2, 0); /* 36 tiles */
    watch w = {0};
    const t3r_hooks hooks = {.user = &w, .progress = look};
    assert_int_equal(t3r_set_hooks(b.rt, &hooks), T3R_OK);
    const t3r_camera camera = plain_camera(SIDE, SIDE * 2, SIDE * 2);
    drawing d = draw(b.rt, &camera, SIDE * 2, SIDE * 2);
    assert_in_range(w.looks, 1 + 36 * COUNT / 65536, 1 + 36);
    drawing_free(&d);
    arena_free(&b.memory);
    free(gaussians);
}
