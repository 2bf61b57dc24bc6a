/* SPDX-License-Identifier: Apache-2.0 */
/* Streams: a camera moves along a textured wall with boxes before it, for a long time. The cap holds, the bits depend
 * on nothing irrelevant, invalid calls are refused, and cancelled ones do no harm. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/float64/drawing.h"
#include "rgbd_frame.h"
#include "sanitized.h"
#include "sanitized_cpu.h"
#include "state/state.h"
#include "stream/stream_map.h"
#include "test.h"

enum { W = 24, H = 16, PIXELS = W * H, CAP = 150, AT_HAND = 3, WALL_MM = 2000, BOX_MM = 1600 };

/* ---- the walk ------------------------------------------------------------------------------------ */

typedef struct pose {
    double x, z, yaw; /* metres, radians; the wall is at z = 2, boxes 0.4 before it */
    bool boxes;
} pose;

static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2];

/* Renders the view of a camera there: the wall's colour by place, depth along the camera's axis, 0 beyond the wall. */
static void look_from(const pose *p, t3r_frame *frame, t3r_camera *camera)
{
    *camera = plain_camera(20, W, H);
    camera->position_q32[0] = (int64_t)(p->x * 4294967296.0);
    camera->position_q32[2] = (int64_t)(p->z * 4294967296.0);
    camera->rotation_q30[0] = (int32_t)(cos(p->yaw / 2) * (1 << 30));
    camera->rotation_q30[2] = (int32_t)(sin(p->yaw / 2) * (1 << 30));
    for (int i = 0; i < PIXELS; i++) {
        double u = (i % W - (W - 1) / 2.0) / 20, v = ((double)(i / W) - (H - 1) / 2.0) / 20;
        double ahead = cos(p->yaw) - u * sin(p->yaw), aside = sin(p->yaw) + u * cos(p->yaw);
        double z = ahead > 0.1 ? (WALL_MM / 1000.0 - p->z) / ahead : 0, x = p->x + aside * z, y = v * z;
        double nearer = ahead > 0.1 ? (BOX_MM / 1000.0 - p->z) / ahead : 0, at = p->x + aside * nearer;
        bool box = p->boxes && nearer > 0.05 && at - floor(at) < 0.3;
        if (box) {
            z = nearer;
            x = at + 17;
            y = v * z;
        }
        uint32_t steps = z > 0 && z < 60 ? (uint32_t)(z * 1000 + 0.5) : 0;
        rgb[3 * i] = (uint8_t)(128 + 90 * sin(x * 3) * cos(y * 4));
        rgb[3 * i + 1] = (uint8_t)(128 + 60 * sin(x * 11 + y * 5));
        rgb[3 * i + 2] = box ? 220 : 60;
        depth[2 * i] = (uint8_t)steps;
        depth[2 * i + 1] = (uint8_t)(steps >> 8);
    }
    *frame = rgbd_frame(rgb, depth, W, H, MILLIMETRE_Q40);
}

static t3r_config stream_config(void)
{
    t3r_config c = t3r_default_config(W, H, AT_HAND, CAP);
    c.stream = 1;
    c.refine = 2;
    c.gate = 0; /* strides are long, and pictures small */
    return c;
}

typedef struct site {
    t3r_config config;
    arena memory;
    t3r_runtime *rt;
    uint32_t calls, cancel_at; /* calls of the progress hook; 0 = never */
    t3r_stage stage;           /* of the last call */
    uint32_t done, steps;      /* `done` of the last call; number of changes of stage or `done` */
} site;

static int progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    site *s = user;
    assert_true(stage < T3R_STAGE_COUNT && done <= total);
    s->steps += s->calls == 0 || stage != s->stage || done != s->done;
    s->stage = stage;
    s->done = done;
    return ++s->calls == s->cancel_at;
}

static void in_reverse(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                       void *context)
{
    (void)user;
    while (count-- > 0) {
        task(context, count, 0);
    }
}

static site site_of(t3r_config config, int arena_size)
{
    site s = {.config = config, .memory = arena_of(&config, arena_size)};
    assert_int_equal(t3r_init(&s.rt, s.memory.bytes, s.memory.count, &config), T3R_OK);
    vectors_if_sanitized(s.rt);
    return s;
}

static t3r_status take(site *s, const pose *p, t3r_stream_report *report)
{
    t3r_frame frame;
    t3r_camera camera;
    look_from(p, &frame, &camera);
    return t3r_stream_keyframe(s->rt, &frame, &camera, report);
}

static t3r_scene scene_of(const site *s)
{
    t3r_scene scene;
    assert_int_equal(t3r_get_scene(s->rt, &scene), T3R_OK);
    return scene;
}

/* Copies the arena elsewhere and overwrites the old place. */
static void move_arena(site *s)
{
    arena other = arena_of_bytes(s->memory.count);
    memcpy(other.bytes, s->memory.bytes, s->memory.count);
    memset(s->memory.bytes, 0x77, s->memory.count);
    arena_free(&s->memory);
    s->memory = other;
    assert_int_equal(t3r_attach(&s->rt, s->memory.bytes, s->memory.count), T3R_OK);
    vectors_if_sanitized(s->rt);
}

/* Walks along the wall, a little to and fro, looking about. */
static pose step_of(uint32_t i)
{
    return (pose){.x = i * 0.3, .z = 0.4 * sin(i * 0.13), .yaw = 0.5 * sin(i * 0.37), .boxes = true};
}

/* ---- tests --------------------------------------------------------------------------------------- */

/* Walks 3 km; with sanitizers in longer strides, as keyframes take ten times as long. */
TEST(the_cap_holds)
{
    enum { STRIDE = T3R_SANITIZED ? 5 : 1, KEYFRAMES = 10000 / STRIDE };
    t3r_config config = stream_config();
    config.refine = 1;
    site s = site_of(config, ARENA_AT_FULL); /* one pass for all views */
    t3r_hooks hooks = {.user = &s, .progress = progress};
    assert_int_equal(t3r_set_hooks(s.rt, &hooks), T3R_OK);
    uint32_t before = 0, most_steps = 0, origins = 0;
    t3r_scene_frame frame = {{0}, 0};
    for (uint32_t i = 0; i < KEYFRAMES; i++) {
        pose p = step_of(i * STRIDE);
        t3r_stream_report r;
        s.calls = s.steps = 0;
        assert_int_equal(take(&s, &p, &r), T3R_OK);
        t3r_scene scene = scene_of(&s);
        assert_int_equal(r.keyframes, i + 1);
        assert_int_equal(r.gaussians, scene.count);
        assert_true(scene.count <= CAP && r.shown <= r.points && r.points <= PIXELS);
        assert_true(r.added <= CAP && r.removed + r.crowded <= before + r.added);
        if (i > 0) {
            bool moved = memcmp(frame.origin_q32, scene.frame.origin_q32, sizeof frame.origin_q32) != 0;
            origins += moved;
            if (!moved) {
                assert_int_equal(r.gaussians, before - r.removed - r.crowded + r.added);
            }
            assert_int_equal(frame.exponent, scene.frame.exponent);
        }
        if (r.crowded > 0) {
            assert_int_equal(scene.count, CAP);
        }
        /* a keyframe takes no more steps at the end than at the beginning; the calls within a step of refinement
         * depend on the tiles' splats */
        most_steps = i < 2 * AT_HAND && s.steps > most_steps ? s.steps : most_steps;
        assert_true(s.steps <= most_steps);
        frame = scene.frame;
        before = scene.count;
        if (i % 500 == 499) {
            move_arena(&s);
            assert_int_equal(t3r_set_hooks(s.rt, &hooks), T3R_OK);
        }
    }
    assert_true(origins >= 2); /* the path is at least 1,500 scene units long */
    arena_free(&s.memory);
}

/* On a long path the map holds what is in front of the camera; the faster the rest fades, the more. */
TEST(follows)
{
    uint32_t near[2] = {0, 0};
    for (int i = 0; i < 2; i++) {
        t3r_config config = stream_config();
        config.half_life = i == 0 ? 0 : 4;
        site s = site_of(config, ARENA_AT_FULL);
        pose p = {0};
        t3r_stream_report r;
        for (uint32_t k = 0; k < 120; k++) {
            p = (pose){k * 0.2, 0, 0, false};
            assert_int_equal(take(&s, &p, &r), T3R_OK);
        }
        assert_int_equal(take(&s, &p, &r), T3R_OK);
        assert_true(r.shown * 4 > PIXELS * 3); /* standing still */
        t3r_scene scene = scene_of(&s);
        for (uint32_t k = 0; k < scene.count; k++) {
            double x = ldexp(scene.gaussians[k].position_q20[0], scene.frame.exponent - 20);
            near[i] += fabs(x - p.x) < 1.2;
        }
        arena_free(&s.memory);
    }
    assert_true(near[1] > 2 * near[0] && near[1] > CAP / 4);
}

TEST(same_bits_whatever_does_not_matter)
{
    enum { WAYS = 6, KEYFRAMES = 25 };
    static t3r_gaussian first[KEYFRAMES][CAP];
    static uint32_t counts[KEYFRAMES];
    for (int way = 0; way < WAYS; way++) {
        const t3r_config config = stream_config();
        site s = site_of(config, way == 1 ? ARENA_AT_MINIMUM : way == 2 ? ARENA_AT_TEN_TIMES : ARENA_AT_FULL);
        t3r_hooks hooks = {.user = &s, .parallel_for = way == 3 ? in_reverse : NULL};
        for (uint32_t i = 0; i < KEYFRAMES; i++) {
            if (way == 4) {
                move_arena(&s);
            }
            assert_int_equal(t3r_set_hooks(s.rt, &hooks), T3R_OK);
            pose p = step_of(i);
            assert_int_equal(take(&s, &p, NULL), T3R_OK);
            if (way == 5) { /* drawing in between */
                t3r_camera camera = plain_camera(20, W, H);
                drawing d = draw(s.rt, &camera, W, H);
                drawing_free(&d);
            }
            t3r_scene scene = scene_of(&s);
            if (way == 0) {
                counts[i] = scene.count;
                memcpy(first[i], scene.gaussians, scene.count * sizeof first[i][0]);
            }
            assert_int_equal(scene.count, counts[i]);
            assert_memory_equal(scene.gaussians, first[i], scene.count * sizeof first[i][0]);
        }
        arena_free(&s.memory);
    }
}

TEST(what_is_shown_adds_nothing)
{
    site s = site_of(stream_config(), ARENA_AT_FULL);
    pose p = {0, 0, 0, false};
    t3r_stream_report r;
    assert_int_equal(take(&s, &p, &r), T3R_OK);
    assert_true(r.added == CAP && r.shown == 0 && r.points == PIXELS && r.gaussians == CAP);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(take(&s, &p, &r), T3R_OK);
        assert_true(r.shown > PIXELS * 9 / 10);
        assert_true(r.added <= CAP / 10 && r.gaussians == CAP && r.removed == 0);
    }
    arena_free(&s.memory);
}

static uint32_t of_boxes(const t3r_scene *scene)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->count; i++) {
        count += ldexp(scene->gaussians[i].position_q20[2], scene->frame.exponent - 20) < 1.8;
    }
    return count;
}

/* The boxes are taken away: the wall behind them becomes visible, and the boxes' Gaussians are removed. */
TEST(contradicted_ones_leave)
{
    site s = site_of(stream_config(), ARENA_AT_FULL);
    pose p = {0, 0, 0, true};
    t3r_stream_report r;
    assert_int_equal(take(&s, &p, &r), T3R_OK);
    t3r_scene scene = scene_of(&s);
    uint32_t there = of_boxes(&scene);
    assert_true(there > CAP / 10);
    p.boxes = false;
    assert_int_equal(take(&s, &p, &r), T3R_OK);
    scene = scene_of(&s);
    assert_true(r.removed > there / 2 && of_boxes(&scene) < there / 2);
    assert_int_equal(scene.count, CAP);
    arena_free(&s.memory);
}

/* At a quarter of the distance the wall has sixteen times the pixels. */
TEST(finer_sights_replace)
{
    site s = site_of(stream_config(), ARENA_AT_FULL);
    pose far = {0, 0, 0, false}, near = {0, 1.5, 0, false};
    t3r_stream_report r;
    assert_int_equal(take(&s, &far, &r), T3R_OK);
    assert_int_equal(take(&s, &near, &r), T3R_OK);
    assert_true(r.removed > 0 && r.added > CAP / 10);
    uint32_t added = r.added;
    assert_int_equal(take(&s, &near, &r), T3R_OK);
    assert_true(r.added < added);
    arena_free(&s.memory);
}

/* At any call where the hook cancels, the map stays valid and later calls work. The report has the keyframe, if it was
 * taken, else zeros. */
TEST(cancelled_anywhere)
{
    const t3r_stream_report nothing = {0};
    uint32_t cancelled = 0;
    for (uint32_t at = 1;; at++) {
        site s = site_of(stream_config(), ARENA_AT_MINIMUM);
        t3r_hooks hooks = {.user = &s, .progress = progress};
        assert_int_equal(t3r_set_hooks(s.rt, &hooks), T3R_OK);
        t3r_status status = T3R_OK;
        for (uint32_t i = 0; i < AT_HAND + 2; i++) {
            pose p = step_of(i);
            s.calls = 0;
            s.cancel_at = i == AT_HAND || (i == 0 && at % 2 == 0) ? at : 0;
            t3r_stream_report r;
            status = take(&s, &p, &r);
            assert_true(status == T3R_OK || (status == T3R_ERR_CANCELLED && s.calls == s.cancel_at));
            cancelled += status == T3R_ERR_CANCELLED;
            if (status == T3R_ERR_CANCELLED && s.stage != T3R_STAGE_REFINE) {
                assert_memory_equal(&r, &nothing, sizeof r);
            } else {
                assert_true(r.keyframes > 0 && r.gaussians > 0);
            }
            t3r_scene scene;
            if (t3r_get_scene(s.rt, &scene) == T3R_OK) {
                assert_true(scene.count <= CAP);
            }
            move_arena(&s);
            assert_int_equal(t3r_set_hooks(s.rt, &hooks), T3R_OK);
        }
        assert_int_equal(status, T3R_OK);
        bool through = s.calls < at;
        arena_free(&s.memory);
        if (through) {
            break;
        }
    }
    assert_true(cancelled > 15);
}

/* Any record of a copied arena, apart from its Gaussians, does no harm. */
TEST(wild_records)
{
    dice d = {3};
    for (int round = 0; round < 40; round++) {
        site s = site_of(stream_config(), ARENA_AT_MINIMUM);
        for (uint32_t i = 0; i < 4; i++) {
            pose p = step_of(i);
            assert_int_equal(take(&s, &p, NULL), T3R_OK);
            uint8_t *records = t3r_buffer_at(s.rt, T3R_BUFFER_MAP_RECORDS);
            for (uint32_t b = 0; b < CAP * T3R_MAP_RECORD_BYTES; b++) {
                records[b] = (uint8_t)dice_below(&d, 256);
            }
            move_arena(&s); /* checks every Gaussian */
        }
        arena_free(&s.memory);
    }
}

static uint32_t overlap_at(const site *s, pose p)
{
    t3r_frame frame;
    t3r_camera camera;
    uint32_t overlap_q8 = 999;
    look_from(&p, &frame, &camera);
    assert_int_equal(t3r_stream_overlap(s->rt, &camera, W, H, &overlap_q8), T3R_OK);
    return overlap_q8;
}

/* The overlap is full at the same place, smaller as the camera moves sideways, turns, comes nearer or retreats, and 0
 * when it looks back. */
TEST(overlap_tells_of_motion)
{
    site s = site_of(stream_config(), ARENA_AT_FULL);
    pose p = {5, 0, 0, false};
    assert_int_equal(take(&s, &p, NULL), T3R_OK);
    assert_int_equal(overlap_at(&s, p), 256);
    const pose ways[] = {{0.3, 0, 0, false}, {0, 0, 0.2, false}, {0, 0.3, 0, false}, {0, -0.8, 0, false}};
    for (int way = 0; way < 4; way++) {
        uint32_t last = 256;
        for (int k = 1; k <= 4; k++) {
            pose q = {5 + k * ways[way].x, k * ways[way].z, k * ways[way].yaw, false};
            uint32_t overlap_q8 = overlap_at(&s, q);
            assert_true(overlap_q8 <= last);
            last = overlap_q8;
        }
        assert_true(last < 160);
    }
    p.yaw = 3.14159;
    assert_int_equal(overlap_at(&s, p), 0);
    p.yaw = 0;
    p.x += 2.4 * 0.75; /* the picture is 2.4 m wide there: a quarter is left */
    uint32_t quarter = overlap_at(&s, p);
    assert_true(quarter >= 64 - 22 && quarter <= 64 + 22);
    arena_free(&s.memory);
}

/* With no depth at the sampled pixels the overlap is unknown. */
TEST(nothing_overlaps_with_nothing)
{
    t3r_config config = stream_config();
    config.fill_radius = config.bridge_radius = 0;
    site s = site_of(config, ARENA_AT_FULL);
    pose p = {5, 0, 0, false};
    t3r_frame frame;
    t3r_camera camera;
    look_from(&p, &frame, &camera);
    for (int i = 0; i < PIXELS; i++) {
        if (i % W % 2 == 0) {
            depth[2 * i] = depth[2 * i + 1] = 0;
        }
    }
    assert_int_equal(t3r_stream_keyframe(s.rt, &frame, &camera, NULL), T3R_OK);
    assert_int_equal(overlap_at(&s, p), 0);
    arena_free(&s.memory);
}

/* A camera that jumps from one end of the range to the other takes the origin along. The previous keyframe is then out
 * of range, so the scene equals one of a stream that begins at the new place. */
TEST(jumps_leave_keyframes_behind)
{
    site s = site_of(stream_config(), ARENA_AT_FULL), fresh = site_of(stream_config(), ARENA_AT_FULL);
    const pose way[] = {{0, 0, 0, true}, {-800, 0, 0, true}, {1800, 0, 0, true}}; /* 2 m a scene unit */
    t3r_stream_report r;
    for (size_t i = 0; i < sizeof way / sizeof way[0]; i++) {
        assert_int_equal(take(&s, &way[i], &r), T3R_OK);
    }
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(s.rt, views);
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(views[1].validity[i], T3R_NO_DEPTH);
    }
    assert_int_equal(take(&fresh, &way[2], NULL), T3R_OK);
    const t3r_scene scene = scene_of(&s), expected = scene_of(&fresh);
    uint32_t there = 0;
    for (uint32_t i = 0; i < scene.count; i++) {
        const double x = ldexp((double)scene.frame.origin_q32[0], -32) +
                         ldexp(scene.gaussians[i].position_q20[0], scene.frame.exponent - 20);
        there += fabs(x - 1800) < 10;
    }
    assert_true(there > expected.count / 3);
    arena_free(&s.memory);
    arena_free(&fresh.memory);
}

/* Checks the status; the report is zeroed, whatever it held before. */
static void assert_refused(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, t3r_status status)
{
    const t3r_stream_report nothing = {0};
    t3r_stream_report report;
    memset(&report, 0xff, sizeof report);
    assert_int_equal(t3r_stream_keyframe(rt, frame, camera, &report), status);
    assert_memory_equal(&report, &nothing, sizeof report);
}

TEST(refused)
{
    site s = site_of(stream_config(), ARENA_AT_FULL);
    t3r_frame frame;
    t3r_camera camera;
    t3r_scene scene;
    t3r_stream_report report;
    const t3r_scene_frame plain = {{0}, 0};
    t3r_gaussian g = round_gaussian(0, 0, 1, 0.1, 0.5, 1, 1, 1);
    pose p = {0, 0, 0, true};
    look_from(&p, &frame, &camera);
    assert_refused(NULL, &frame, &camera, T3R_ERR_ARGUMENT);
    assert_refused(s.rt, NULL, &camera, T3R_ERR_ARGUMENT);
    assert_refused(s.rt, &frame, NULL, T3R_ERR_ARGUMENT);
    uint32_t overlap_q8;
    assert_int_equal(t3r_stream_overlap(s.rt, &camera, W, H, &overlap_q8), T3R_ERR_STATE);
    assert_int_equal(t3r_stream_overlap(NULL, &camera, W, H, &overlap_q8), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_stream_overlap(s.rt, &camera, 1, H, &overlap_q8), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_add_view(s.rt, &frame, &camera), T3R_ERR_STATE);
    assert_int_equal(t3r_reconstruct(s.rt, NULL, &scene), T3R_ERR_STATE);
    assert_int_equal(t3r_rebuild(s.rt, &(t3r_request){.gaussians = 10}, &scene), T3R_ERR_STATE);
    assert_int_equal(t3r_scene_begin(s.rt, &plain), T3R_ERR_STATE);
    assert_int_equal(t3r_get_scene(s.rt, &scene), T3R_ERR_STATE);
    assert_int_equal(take(&s, &p, &report), T3R_OK);
    assert_int_equal(t3r_scene_append(s.rt, &g), T3R_ERR_STATE);

    /* none of these changes the arena */
    arena before = arena_of_bytes(s.memory.count);
    memcpy(before.bytes, s.memory.bytes, s.memory.count);
    look_from(&p, &frame, &camera);
    t3r_camera far = camera;
    far.position_q32[0] = (int64_t)5000 << 32;
    assert_refused(s.rt, &frame, &far, T3R_ERR_CAMERA);
    assert_int_equal(t3r_stream_overlap(s.rt, &far, W, H, &overlap_q8), T3R_ERR_CAMERA);
    /* with pictures this large the focal length would be below 8 pixels at the working size */
    assert_int_equal(t3r_stream_overlap(s.rt, &camera, T3R_MAX_SIDE, T3R_MAX_SIDE, &overlap_q8), T3R_ERR_CAMERA);
    t3r_camera folded = camera; /* a lens that shows nothing in most of the picture */
    folded.distortion = T3R_DISTORTION_RADTAN;
    folded.distortion_q24[0] = -(40 << 24);
    assert_refused(s.rt, &frame, &folded, T3R_ERR_CAMERA);
    assert_int_equal(scene_of(&s).count, CAP);
    assert_int_equal(t3r_reset(s.rt), T3R_OK);
    assert_int_equal(take(&s, &p, &report), T3R_OK);
    memcpy(before.bytes, s.memory.bytes, s.memory.count);
    t3r_frame bad = frame;
    bad.stride_bytes[0] = 1;
    assert_refused(s.rt, &bad, &camera, T3R_ERR_FRAME);
    bad = frame;
    bad.depth = NULL;
    assert_refused(s.rt, &bad, &camera, T3R_ERR_NO_DEPTH);
    assert_memory_equal(before.bytes, s.memory.bytes, s.memory.count);
    memset(depth, 0, sizeof depth);
    assert_refused(s.rt, &frame, &camera, T3R_ERR_NO_DEPTH);
    assert_int_equal(scene_of(&s).count, CAP);
    assert_int_equal(t3r_reset(s.rt), T3R_OK);
    assert_int_equal(take(&s, &p, &report), T3R_OK);
    assert_int_equal(report.keyframes, 1);
    arena_free(&before);
    arena_free(&s.memory);

    t3r_config config = t3r_default_config(W, H, 2, CAP);
    site ordinary = site_of(config, ARENA_AT_FULL);
    assert_refused(ordinary.rt, &frame, &camera, T3R_ERR_STATE);
    arena_free(&ordinary.memory);
    config = stream_config();
    config.head = T3R_HEAD_LEARNED;
    site headless = site_of(config, ARENA_AT_FULL);
    assert_refused(headless.rt, &frame, &camera, T3R_ERR_STATE);
    arena_free(&headless.memory);
    config.views = 0;
    assert_non_null(t3r_config_error(&config));
}
