/* SPDX-License-Identifier: Apache-2.0 */
/* The backdrop and the rim are inside the budget and have no depth. The backdrop leaves no pixel of an orbit black, the
 * rim lies outside the pictures and behind the surfaces. Same bits by every variant. */
#include "rgbd_frame.h"
#include "unit/unit.h"

#include "core/fixed.h"
#include "core/hash.h"
#include "host/cpu.h"
#include "room/room.h"

enum { SIDE = 64, PIXELS = SIDE * SIDE, MOST = 864, DIRECTIONS = 16 };

/* A runtime, its scene, and a render of it. */
typedef struct place {
    void *memory;
    t3r_runtime *rt;
    t3r_scene scene;
    uint8_t rgb[PIXELS * 3];
    uint32_t depth_q20[PIXELS];
    uint16_t alpha_q15[PIXELS];
} place;

static place *open_place(const t3r_config *config)
{
    place *p = calloc(1, sizeof *p);
    size_t least, bytes;
    assert_non_null(p);
    assert_int_equal(t3r_plan_bytes(config, &least, &bytes), T3R_OK);
    assert_int_equal(posix_memalign(&p->memory, T3R_ARENA_ALIGN, bytes), 0);
    assert_int_equal(t3r_init(&p->rt, p->memory, bytes, config), T3R_OK);
    return p;
}

static void close_place(place *p)
{
    free(p->memory);
    free(p);
}

/* Builds a scene of two views of the room. */
static place *build(t3r_config config, uint32_t features)
{
    config.keep_analysis = !config.stream;
    place *p = open_place(&config);
    assert_int_equal(t3r_set_cpu(p->rt, features), T3R_OK);
    for (uint32_t v = 0; v < 2; v++) {
        static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2];
        static uint16_t depth_mm[PIXELS];
        t3r_camera camera;
        room_camera(2 * v, SIDE, SIDE, &camera);
        room_frame(2 * v, SIDE, SIDE, 1, rgb, depth_mm);
        for (uint32_t i = 0; i < PIXELS; i++) {
            depth[2 * i] = (uint8_t)depth_mm[i];
            depth[2 * i + 1] = (uint8_t)(depth_mm[i] >> 8);
        }
        const t3r_frame frame = rgbd_frame(rgb, depth, SIDE, SIDE, ROOM_DEPTH_UNIT_Q40);
        assert_int_equal(config.stream ? t3r_stream_keyframe(p->rt, &frame, &camera, NULL)
                                       : t3r_add_view(p->rt, &frame, &camera),
                         T3R_OK);
    }
    assert_int_equal(config.stream ? t3r_get_scene(p->rt, &p->scene) : t3r_reconstruct(p->rt, NULL, &p->scene), T3R_OK);
    return p;
}

static t3r_config config_of(uint32_t gaussians, uint32_t refine)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, 2, gaussians);
    config.backdrop = 1;
    config.refine = refine;
    return config;
}

static bool is_far(const t3r_gaussian *g)
{
    int64_t most = 0;
    for (int i = 0; i < 3; i++) {
        most = llabs(g->position_q20[i]) > most ? llabs(g->position_q20[i]) : most;
    }
    return most > 100 << 20;
}

/* Counts the Gaussians of the backdrop that are far, or those of its rim. */
static uint32_t count_backdrop(const t3r_scene *scene, bool far)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->count; i++) {
        count += scene->gaussians[i].view == T3R_NO_VIEW && is_far(&scene->gaussians[i]) == far;
    }
    return count;
}

TEST(test_the_budget_is_exact)
{
    const struct {
        uint32_t budget, backdrop, rim_most; /* of two views */
    } cases[] = {{1, 0, 0},     {95, 0, 0},    {96, 6, 0},    {383, 6, 0},  {384, 24, 24},
                 {767, 24, 24}, {768, 24, 48}, {863, 24, 48}, {864, 54, 48}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        for (uint32_t refine = 0; refine <= 2; refine += 2) {
            place *p = build(config_of(cases[i].budget, refine), 0);
            assert_int_equal(p->scene.count, cases[i].budget);
            assert_int_equal(count_backdrop(&p->scene, true), cases[i].backdrop);
            const uint32_t rim = count_backdrop(&p->scene, false);
            assert_true(cases[i].rim_most == 0 ? rim == 0 : rim >= cases[i].rim_most / 4 && rim <= cases[i].rim_most);
            close_place(p);
        }
    }
}

/* A rim is a guess, as filled holes are. */
TEST(test_no_guess_no_rim)
{
    t3r_config config = config_of(MOST, 0);
    config.guess = 0;
    place *p = build(config, 0);
    assert_int_equal(count_backdrop(&p->scene, false), 0);
    assert_int_equal(count_backdrop(&p->scene, true), 54);
    close_place(p);
}

/* Backdrop and rim fit what there is, not what was asked for: they are inside the number of valid points, too. */
TEST(test_they_raise_no_budget_above_the_points)
{
    for (uint32_t missing = 0; missing < SIDE; missing += SIDE / 2 - 4) {
        static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2];
        t3r_config config = t3r_default_config(SIDE, SIDE, 1, PIXELS);
        config.bridge_radius = config.fill_radius = config.refine = 0;
        config.backdrop = 1;
        memset(rgb, 100, sizeof rgb);
        for (uint32_t i = 0; i < PIXELS; i++) {
            depth[2 * i + 1] = i % SIDE >= missing ? 4 : 0;
        }
        place *p = open_place(&config);
        const t3r_frame frame = rgbd_frame(rgb, depth, SIDE, SIDE, ROOM_DEPTH_UNIT_Q40);
        const t3r_camera camera = straight_camera(SIDE);
        assert_int_equal(t3r_add_view(p->rt, &frame, &camera), T3R_OK);
        assert_int_equal(t3r_reconstruct(p->rt, NULL, &p->scene), T3R_OK);
        assert_int_equal(p->scene.valid_points, SIDE * (SIDE - missing));
        assert_int_equal(p->scene.count, p->scene.valid_points);
        assert_true(count_backdrop(&p->scene, true) > 0);
        close_place(p);
    }
}

TEST(test_streams_and_settings_without_it_have_none)
{
    for (uint32_t backdrop = 0; backdrop <= 1; backdrop++) {
        for (uint32_t rim = 0; rim <= 1; rim++) {
            t3r_config config = config_of(MOST, 0);
            config.backdrop = backdrop;
            config.rim = rim;
            for (config.stream = 0; config.stream <= 1; config.stream++) {
                place *p = build(config, 0);
                assert_int_equal(count_backdrop(&p->scene, true) != 0, backdrop && !config.stream);
                assert_int_equal(count_backdrop(&p->scene, false) != 0, rim && !config.stream);
                close_place(p);
            }
        }
    }
}

/* Draws a view of an orbit around the room: outwards at half of them, inwards from afar at the others. */
static void draw(place *p, uint32_t view)
{
    const double turn = 6.283185307179586 * view / DIRECTIONS, tilt = 0.6 * ((int)(view % 3) - 1);
    const double away = view % 2 == 0 ? 0.5 : -9,
                 q[4] = {cos(turn / 2) * cos(tilt / 2), cos(turn / 2) * sin(tilt / 2), sin(turn / 2) * cos(tilt / 2),
                         -sin(turn / 2) * sin(tilt / 2)};
    t3r_camera camera = straight_camera(SIDE);
    camera.position_q32[0] = (int64_t)(away * sin(turn) * 0x1p32);
    camera.position_q32[2] = (int64_t)((2 + away * cos(turn)) * 0x1p32);
    for (int i = 0; i < 4; i++) {
        camera.rotation_q30[i] = (int32_t)(q[i] * (1 << 30));
    }
    const t3r_target target = {.width = SIDE,
                               .height = SIDE,
                               .rgb = p->rgb,
                               .rgb_stride_bytes = 3 * SIDE,
                               .depth_q20 = p->depth_q20,
                               .depth_stride_bytes = 4 * SIDE,
                               .alpha_q15 = p->alpha_q15,
                               .alpha_stride_bytes = 2 * SIDE};
    assert_int_equal(t3r_render(p->rt, &camera, &target), T3R_OK);
}

/* Makes the scene without its backdrop. */
static place *without_backdrop(const place *p)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, 0, MOST);
    config.refine = config.align = config.fit_widths = 0;
    place *bare = open_place(&config);
    assert_int_equal(t3r_scene_begin(bare->rt, &p->scene.frame), T3R_OK);
    for (uint32_t i = 0; i < p->scene.count; i++) {
        if (p->scene.gaussians[i].view != T3R_NO_VIEW) {
            assert_int_equal(t3r_scene_append(bare->rt, &p->scene.gaussians[i]), T3R_OK);
        }
    }
    return bare;
}

/* Checks that no pixel is black, and that depth is that of surfaces: exactly without a rim. Before a surface the thin
 * outskirts of the rim change which of its Gaussians halves the light, and the rest of it leaves the depth unknown. */
static void check_orbit(uint32_t budget, uint8_t rim)
{
    t3r_config config = config_of(budget, 0);
    config.rim = rim;
    place *p = build(config, 0), *bare = without_backdrop(p);
    uint32_t beyond = 0, other = 0, with_depth = 0;
    for (uint32_t view = 0; view < DIRECTIONS; view++) {
        draw(p, view);
        draw(bare, view);
        for (uint32_t i = 0; i < PIXELS; i++) {
            const uint8_t *rgb = p->rgb + (size_t)3 * i;
            if (p->alpha_q15[i] < 28000 || rgb[0] + rgb[1] + rgb[2] < 60) {
                fail_msg("budget %u, view %u, pixel %u: alpha %u, colour %u %u %u", budget, view, i, p->alpha_q15[i],
                         rgb[0], rgb[1], rgb[2]);
            }
            const uint32_t z = p->depth_q20[i], bare_z = bare->depth_q20[i];
            assert_true(rim || z == bare_z);
            other += llabs((int64_t)z - bare_z) > bare_z / 8;
            with_depth += bare_z != 0;
            beyond += bare->alpha_q15[i] == 0;
        }
    }
    assert_true(beyond > DIRECTIONS * PIXELS / 4);
    assert_true(other <= with_depth / 50);
    close_place(p);
    close_place(bare);
}

TEST(test_an_orbit_is_not_black_and_has_no_new_depth)
{
    check_orbit(96, 0);
    for (uint8_t rim = 0; rim <= 1; rim++) {
        check_orbit(384, rim);
        check_orbit(MOST, rim);
    }
}

/* Checks that the backdrop is light above and dark below where the pictures are: in the borders' colours. */
TEST(test_colours_are_those_of_the_borders)
{
    static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2];
    t3r_config config = t3r_default_config(SIDE, SIDE, 1, MOST);
    config.backdrop = 1;
    config.refine = config.align = config.fit_widths = 0;
    place *p = open_place(&config);
    for (uint32_t i = 0; i < PIXELS; i++) {
        const bool above = i / SIDE < SIDE / 2, border = i / SIDE == 0 || i / SIDE == SIDE - 1;
        rgb[3 * i] = border && above ? 200 : 0;
        rgb[3 * i + 2] = border && !above ? 200 : 0;
        depth[2 * i + 1] = 4;
    }
    const t3r_frame frame = rgbd_frame(rgb, depth, SIDE, SIDE, ROOM_DEPTH_UNIT_Q40);
    const t3r_camera camera = straight_camera(SIDE);
    assert_int_equal(t3r_add_view(p->rt, &frame, &camera), T3R_OK);
    assert_int_equal(t3r_reconstruct(p->rt, NULL, &p->scene), T3R_OK);
    uint32_t seen = 0;
    for (uint32_t i = 0; i < p->scene.count; i++) {
        const t3r_gaussian *g = &p->scene.gaussians[i];
        if (g->view == T3R_NO_VIEW && is_far(g) && g->position_q20[2] > 0 && g->position_q20[0] == 0 &&
            g->position_q20[1] != 0) {
            assert_true(g->position_q20[1] < 0 ? g->colour_q7[0] > 2 * g->colour_q7[2]
                                               : g->colour_q7[2] > 2 * g->colour_q7[0]);
            seen++;
        }
    }
    assert_int_equal(seen, 4); /* two of the face ahead, and one of each face above and below */
    close_place(p);
}

/* Builds views of a wall parallel to their pictures, each a quarter of a picture to the right of the one before. */
static place *build_wall(uint32_t views)
{
    enum { STEPS = 1024 }; /* of depth */
    static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2];
    t3r_config config = t3r_default_config(SIDE, SIDE, views, 384 * views);
    config.refine = config.align = config.exposure = 0;
    place *p = open_place(&config);
    for (uint32_t i = 0; i < PIXELS; i++) {
        rgb[3 * i] = (uint8_t)(i % SIDE * 4); /* from black at the left to bright at the right */
        rgb[3 * i + 1] = 100;
        depth[2 * i + 1] = STEPS >> 8;
    }
    const t3r_frame frame = rgbd_frame(rgb, depth, SIDE, SIDE, ROOM_DEPTH_UNIT_Q40);
    t3r_camera camera = straight_camera(SIDE);
    const int64_t distance_q32 = STEPS * (int64_t)ROOM_DEPTH_UNIT_Q40 >> 8;
    for (uint32_t v = 0; v < views; v++) {
        assert_int_equal(t3r_add_view(p->rt, &frame, &camera), T3R_OK);
        camera.position_q32[0] += distance_q32 * SIDE / camera.fx_q16 * (1 << 16) / 4;
    }
    assert_int_equal(t3r_reconstruct(p->rt, NULL, &p->scene), T3R_OK);
    return p;
}

/* Beyond each border of a wall lie two rings outside the picture, in the border's colour: four Gaussians a side at 1/16
 * of the picture, 5/4 as far as the wall, and two at 5/16, four times as far as these. */
TEST(test_the_rim_is_outside_the_picture)
{
    place *p = build_wall(1);
    int64_t wall = 0, edge = 0;
    for (uint32_t i = 0; i < p->scene.count; i++) {
        const t3r_gaussian *g = &p->scene.gaussians[i];
        wall = g->view == T3R_NO_VIEW ? wall : g->position_q20[2];
        edge = g->view == T3R_NO_VIEW ? edge : T3R_MAX(edge, llabs(g->position_q20[0]));
    }
    uint32_t left = 0, right = 0, others = 0, inner = 0, outer = 0;
    for (uint32_t i = 0; i < p->scene.count; i++) {
        const t3r_gaussian *g = &p->scene.gaussians[i];
        if (g->view != T3R_NO_VIEW) {
            continue;
        }
        const int64_t times = g->position_q20[2] > 2 * wall ? 20 : 5; /* in quarters of the wall's distance */
        assert_true(llabs(4 * g->position_q20[2] - times * wall) <= wall >> 6);
        assert_int_equal(g->confidence, 0);
        const int64_t x = llabs(g->position_q20[0]), y = llabs(g->position_q20[1]);
        const bool sideways = x > y;
        left += sideways && g->position_q20[0] < 0 && g->colour_q7[0] < 20 << 7;
        right += sideways && g->position_q20[0] > 0 && g->colour_q7[0] > 230 << 7;
        others += !sideways && g->colour_q7[0] > 10 << 7 && g->colour_q7[0] < 245 << 7;
        /* of the picture, beyond its border */
        const int64_t sixteenths = (4 * T3R_MAX(x, y) - times * edge) * 8 / (times * edge);
        inner += times == 5 && sixteenths >= 0 && sixteenths <= 1;
        outer += times == 20 && sixteenths >= 4 && sixteenths <= 5;
    }
    assert_int_equal(left, 4 + 2);
    assert_int_equal(right, 4 + 2);
    assert_int_equal(others, 8 + 4);
    assert_int_equal(inner, 16);
    assert_int_equal(outer, 8);
    close_place(p);
}

/* The rim leaves out what another view shows. The second view is a quarter of a picture to the right, so each of the
 * two leaves out the inner ring on its side towards the other. */
TEST(test_the_rim_leaves_out_what_another_view_shows)
{
    place *one = build_wall(1), *two = build_wall(2);
    assert_int_equal(count_backdrop(&one->scene, false), 24);
    assert_int_equal(count_backdrop(&two->scene, false), 2 * 24 - 2 * 4);
    close_place(one);
    close_place(two);
}

/* Refinement corrects the colours of backdrop and rim, and leaves the rest as it is. */
TEST(test_refinement_corrects_colours_alone)
{
    place *before = build(config_of(MOST, 0), 0), *after = build(config_of(MOST, 4), 0);
    uint32_t changed = 0;
    for (uint32_t i = 0; i < MOST; i++) {
        t3r_gaussian a = before->scene.gaussians[i], b = after->scene.gaussians[i];
        if (a.view == T3R_NO_VIEW) {
            changed += memcmp(a.colour_q7, b.colour_q7, sizeof a.colour_q7) != 0;
            memcpy(b.colour_q7, a.colour_q7, sizeof a.colour_q7);
            assert_memory_equal(&a, &b, sizeof a);
        }
    }
    assert_true(changed > 10);
    close_place(before);
    close_place(after);
}

TEST(test_every_variant_has_the_same_bits)
{
    const uint32_t features[] = {0, t3r_cpu_features()};
    uint64_t hash[2];
    for (int i = 0; i < 2; i++) {
        place *p = build(config_of(MOST, 2), features[i]);
        hash[i] = t3r_hash_bytes(T3R_HASH_START, (const uint8_t *)p->scene.gaussians,
                                 p->scene.count * sizeof *p->scene.gaussians);
        for (uint32_t view = 0; view < DIRECTIONS; view++) {
            draw(p, view);
            hash[i] = t3r_hash_bytes(hash[i], p->rgb, sizeof p->rgb);
            hash[i] = t3r_hash_bytes(hash[i], (const uint8_t *)p->depth_q20, sizeof p->depth_q20);
        }
        close_place(p);
    }
    assert_int_equal(hash[0], hash[1]);
}
