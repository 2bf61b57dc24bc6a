/* SPDX-License-Identifier: Apache-2.0 */
/* Depth by stereo in the pipeline: the built-in room from colours alone, refusals, more than two views, and its parts:
 * combining several pairs, filling unmatched pixels. */
#include "rgbd_frame.h"
#include "unit/unit.h"

#include "core/fixed.h"
#include "core/hash.h"
#include "pipeline.h"
#include "room/room.h"
#include "state/state.h"
#include "stereo/planes/plane_fill.h"
#include "stereo/stereo.h"
#include "stereo/stereo_fuse.h"

enum { W = 128, H = 96, PIXELS = W * H, BUDGET = 1500, MOST = 5 };

/* Frames of the room, or a test's own in their place. */
typedef struct shots {
    uint8_t *rgb[MOST];
    uint16_t *depth[MOST]; /* true depth, millimetres */
    t3r_camera camera[MOST];
    uint32_t count;
} shots;

static shots room_shots(const uint32_t *frames, uint32_t count)
{
    shots s = {.count = count};
    for (uint32_t v = 0; v < count; v++) {
        s.rgb[v] = unit_array(PIXELS, 3);
        s.depth[v] = unit_array(PIXELS, 2);
        room_frame(frames[v], W, H, 1, s.rgb[v], s.depth[v]);
        room_camera(frames[v], W, H, &s.camera[v]);
    }
    return s;
}

static void shots_free(shots *s)
{
    for (uint32_t v = 0; v < s->count; v++) {
        free(s->rgb[v]);
        free(s->depth[v]);
    }
}

/* A runtime in an arena of its own, and the reports of its stages. */
typedef struct bench {
    t3r_config config;
    t3r_runtime *rt;
    void *arena;
    size_t bytes;
    uint64_t hash;
    int cancel; /* the call of the progress hook in stage depth that cancels, from 1; 0 = none */
    int calls;
    uint32_t told; /* bit n: stage depth reported n parts done */
} bench;

static void on_hash(void *user, t3r_stage stage, uint64_t hash)
{
    bench *b = user;
    b->hash = t3r_hash_u64(t3r_hash_u8(b->hash, (uint8_t)stage), hash);
}

static int on_progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    bench *b = user;
    assert_true(done < total);
    b->told |= stage == T3R_STAGE_DEPTH ? 1u << done : 0;
    return stage == T3R_STAGE_DEPTH && ++b->calls == b->cancel;
}

static bench open_bench(uint32_t views)
{
    bench b = {.config = t3r_default_config(W, H, views, BUDGET)};
    b.config.depth = T3R_DEPTH_STEREO;
    b.config.clusters = 32;
    b.config.refine = b.config.rim = 0;
    b.config.keep_analysis = 1;
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(&b.config, &plan), T3R_OK);
    b.bytes = (plan.min_bytes + 63) / 64 * 64;
    b.arena = aligned_alloc(T3R_ARENA_ALIGN, b.bytes);
    assert_non_null(b.arena);
    assert_int_equal(t3r_init(&b.rt, b.arena, b.bytes, &b.config), T3R_OK);
    return b;
}

static void add(bench *b, const shots *s, uint32_t v, const uint16_t *depth, uint64_t unit_q40)
{
    const t3r_frame frame = rgbd_frame(s->rgb[v], (const uint8_t *)depth, W, H, unit_q40);
    assert_int_equal(t3r_add_view(b->rt, &frame, &s->camera[v]), T3R_OK);
}

static void add_all(bench *b, const shots *s)
{
    for (uint32_t v = 0; v < s->count; v++) {
        add(b, s, v, NULL, 0);
    }
}

static t3r_status reconstruct(bench *b, t3r_scene *scene)
{
    const t3r_hooks hooks = {.user = b, .stage_hash = on_hash, .progress = on_progress};
    assert_int_equal(t3r_set_hooks(b->rt, &hooks), T3R_OK);
    b->hash = T3R_HASH_START;
    b->calls = 0;
    b->told = 0;
    return t3r_reconstruct(b->rt, NULL, scene);
}

/* For a view: pixels matched with confidence, the share of these off by more than a tenth, pixels without depth. */
typedef struct verdict {
    uint32_t measured, none;
    double wrong;
} verdict;

static verdict judge(const bench *b, const shots *s, uint32_t v)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(b->rt, views);
    verdict found = {0};
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const uint8_t validity = views[v].validity[i];
        const double depth = views[v].depth[i] * ldexp((double)views[v].depth_unit_q40, -40);
        const double truth = s->depth[v][i] * ldexp((double)ROOM_DEPTH_UNIT_Q40, -40);
        const int measured = t3r_is_measured(validity) && !t3r_is_doubtful(validity);
        found.measured += (uint32_t)measured;
        found.none += validity == T3R_NO_DEPTH;
        wrong += measured && fabs(depth / truth - 1) > 0.1;
        assert_int_equal(validity == T3R_NO_DEPTH, views[v].depth[i] == 0);
    }
    found.wrong = found.measured == 0 ? 0 : (double)wrong / found.measured;
    return found;
}

/* ---- two views --------------------------------------------------------------------------------------------------- */

TEST(colours_alone)
{
    shots s = room_shots((const uint32_t[]){0, 2}, 2);
    bench b = open_bench(2);
    t3r_scene scene;
    add_all(&b, &s);
    assert_int_equal(reconstruct(&b, &scene), T3R_OK);
    const uint64_t hash = b.hash;
    assert_int_equal(scene.count, BUDGET);
    for (uint32_t v = 0; v < 2; v++) {
        const verdict found = judge(&b, &s, v);
        print_message("view %u: %u of %u pixels measured, %.1f %% of these off\n", v, found.measured, PIXELS,
                      100 * found.wrong);
        assert_true(found.measured > PIXELS / 2 && found.wrong < 0.15);
        assert_int_equal(found.none, 0); /* filled */
        uint32_t partner;
        assert_int_equal(t3r_stereo_pair(b.rt, v, &partner), T3R_PAIR_OK);
        assert_int_equal(partner, 1 - v);
    }
    assert_true(scene.valid_points > PIXELS && scene.valid_points < 2 * PIXELS);
    /* doubtful points come last */
    for (uint32_t i = 0; i < scene.count; i++) {
        assert_true(scene.gaussians[i].confidence > t3r_confidence_of(T3R_MEASURED | T3R_MARK_DOUBTFUL));
    }
    /* again from the same planes, which now hold depth */
    assert_int_equal(reconstruct(&b, &scene), T3R_OK);
    assert_int_equal(b.hash, hash);
    /* a sensor's depth, even nonsense, is ignored */
    assert_int_equal(t3r_reset(b.rt), T3R_OK);
    add(&b, &s, 0, s.depth[1], 0);
    add(&b, &s, 1, s.depth[0], UINT64_MAX);
    assert_int_equal(reconstruct(&b, &scene), T3R_OK);
    assert_int_equal(b.hash, hash);
    /* and an arena works after a move */
    void *moved = aligned_alloc(T3R_ARENA_ALIGN, b.bytes);
    t3r_runtime *rt;
    assert_non_null(moved);
    memcpy(moved, b.arena, b.bytes);
    assert_int_equal(t3r_attach(&rt, moved, b.bytes), T3R_OK);
    assert_int_equal(t3r_rebuild(rt, &(t3r_request){.gaussians = BUDGET / 2}, &scene), T3R_OK);
    assert_int_equal(scene.count, BUDGET / 2);
    rt->stereo_pair[1] = T3R_PAIR_COUNT;
    assert_int_equal(t3r_attach(&rt, moved, b.bytes), T3R_ERR_EPOCH);
    free(moved);
    free(b.arena);
    shots_free(&s);
}

/* Depth that another runtime found is taken, once and for the same views alone. */
TEST(taken_from_another)
{
    shots s = room_shots((const uint32_t[]){0, 2, 1}, 3);
    bench b = open_bench(3), from = open_bench(3);
    t3r_scene scene;
    t3r_view views[T3R_MAX_VIEWS];
    add_all(&b, &s);
    assert_int_equal(reconstruct(&b, &scene), T3R_OK);
    const uint64_t hash = b.hash;
    const int calls = b.calls;
    add_all(&from, &s);
    t3r_views_of(from.rt, views);
    assert_int_equal(t3r_find_points(from.rt, views), T3R_OK);
    assert_int_equal(from.rt->valid_points, scene.valid_points);
    b.rt->depth_of = from.rt;
    assert_int_equal(reconstruct(&b, &scene), T3R_OK);
    assert_int_equal(b.hash, hash);
    assert_int_equal(b.calls, 0); /* of stage depth */
    for (uint32_t v = 0; v < 3; v++) {
        uint32_t partner, found;
        assert_int_equal(t3r_stereo_pair(b.rt, v, &partner), t3r_stereo_pair(from.rt, v, &found));
        assert_int_equal(partner, found);
    }
    assert_int_equal(reconstruct(&b, &scene), T3R_OK); /* finds its own */
    assert_int_equal(b.calls, calls);
    t3r_view other = t3r_view_of(from.rt, 1);
    for (int difference = 0; difference < 7; difference++) {
        other.colour[2][PIXELS - 1] ^= difference == 0;
        from.rt->camera[1].fx_q16 += difference == 1;
        from.rt->config.fill_radius -= difference == 2;
        from.rt->views -= difference == 3;
        from.rt->config.width -= difference == 4;
        from.rt->config.height -= difference == 5;
        from.rt->config.depth = difference == 6 ? T3R_DEPTH_SENSOR : T3R_DEPTH_STEREO;
        b.rt->depth_of = from.rt;
        assert_int_equal(reconstruct(&b, &scene), T3R_OK);
        assert_int_equal(b.hash, hash);
        assert_int_equal(b.calls, calls);
        other.colour[2][PIXELS - 1] ^= difference == 0;
        from.rt->camera[1].fx_q16 -= difference == 1;
        from.rt->config.fill_radius += difference == 2;
        from.rt->views += difference == 3;
        from.rt->config.width += difference == 4;
        from.rt->config.height += difference == 5;
    }
    b.rt->depth_of = from.rt; /* an arena that moved has no other */
    t3r_runtime *rt;
    assert_int_equal(t3r_attach(&rt, b.arena, b.bytes), T3R_OK);
    assert_null(rt->depth_of);
    free(from.arena);
    free(b.arena);
    shots_free(&s);
}

TEST(unfilled)
{
    shots s = room_shots((const uint32_t[]){0, 2}, 2);
    bench b = open_bench(2);
    t3r_scene scene, filled;
    add_all(&b, &s);
    assert_int_equal(reconstruct(&b, &filled), T3R_OK);
    b.rt->config.fill_radius = 0;
    assert_int_equal(reconstruct(&b, &scene), T3R_OK);
    assert_int_equal(scene.valid_points, filled.valid_points); /* filling adds nothing to the budget */
    const verdict left = judge(&b, &s, 0), right = judge(&b, &s, 1);
    assert_int_equal(left.none + right.none, 2 * PIXELS - scene.valid_points);
    free(b.arena);
    shots_free(&s);
}

/* Returns a slanted wall, with texture only at its left and right. */
static shots wall_shots(void)
{
    shots s = {.count = 2};
    uint64_t noise = 3;
    for (uint32_t view = 0; view < 2; view++) {
        s.rgb[view] = unit_array(PIXELS, 3);
        s.depth[view] = unit_array(PIXELS, 2);
        s.camera[view] = (t3r_camera){.fx_q16 = 100 << 16,
                                      .fy_q16 = 100 << 16,
                                      .cx_q16 = W << 15,
                                      .cy_q16 = H << 15,
                                      .rotation_q30 = {1 << 30},
                                      .position_q32 = {view * (INT64_C(1) << 31)}}; /* half a unit apart */
        for (uint32_t i = 0; i < PIXELS; i++) {
            const double across = (i % W - W / 2.0) / 100, down = (i / W - H / 2.0) / 100, from = view * 0.5;
            const double z = (3 + 0.6 * from) / (1 - 0.6 * across), x = from + across * z, y = down * z;
            const uint32_t patch = (uint32_t)floor(12 * x + 500) * 1000 + (uint32_t)floor(12 * y + 500);
            uint64_t seed = patch;
            (void)unit_random(&seed);
            const uint8_t grey = fabs(x - 0.2) < 0.8 ? (uint8_t)(178 + unit_random(&noise) % 4)
                                                     : (uint8_t)(20 + unit_random(&seed) % 200);
            memset(s.rgb[view] + 3 * (size_t)i, grey, 3);
            s.depth[view][i] = (uint16_t)lround(1000 * z);
        }
    }
    return s;
}

/* Returns the share of a view's pixels whose depth, from any source, is off by more than `part`. */
static double off_by(const bench *b, const shots *s, uint32_t v, double part)
{
    t3r_view views[T3R_MAX_VIEWS];
    uint32_t off = 0;
    t3r_views_of(b->rt, views);
    for (uint32_t i = 0; i < PIXELS; i++) {
        const double depth = views[v].depth[i] * ldexp((double)views[v].depth_unit_q40, -40);
        off += fabs(depth / (s->depth[v][i] * ldexp((double)ROOM_DEPTH_UNIT_Q40, -40)) - 1) > part;
    }
    return (double)off / PIXELS;
}

/* A bare wall gets its depth from the planes of what is matched beside it; without filling it has none. */
TEST(planes)
{
    shots s = wall_shots();
    bench b = open_bench(2);
    t3r_scene scene;
    add_all(&b, &s);
    assert_int_equal(reconstruct(&b, &scene), T3R_OK);
    const double off = (off_by(&b, &s, 0, 0.05) + off_by(&b, &s, 1, 0.05)) / 2;
    print_message("%.1f %% off\n", 100 * off);
    assert_true(off < 0.37); /* 0.41 by the surroundings alone */
    b.rt->config.fill_radius = 0;
    assert_int_equal(reconstruct(&b, &scene), T3R_OK);
    assert_true(judge(&b, &s, 0).none > 0);
    free(b.arena);
    shots_free(&s);
}

/* Black areas are neither matched nor filled. */
TEST(nothing_shown)
{
    shots s = room_shots((const uint32_t[]){0, 2}, 2);
    bench b = open_bench(2);
    t3r_scene scene;
    for (uint32_t y = 0; y < H; y++) {
        memset(s.rgb[0] + (size_t)y * 3 * W, 0, 3 * W / 4);
        memset(s.rgb[1] + (size_t)y * 3 * W, 0, 3 * W / 4);
    }
    add_all(&b, &s);
    assert_int_equal(reconstruct(&b, &scene), T3R_OK);
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(b.rt, views);
    for (uint32_t v = 0; v < 2; v++) {
        for (uint32_t i = 0; i < PIXELS; i++) {
            const int black = (views[v].colour[0][i] | views[v].colour[1][i] | views[v].colour[2][i]) == 0;
            assert_int_equal(views[v].depth[i] == 0, black);
        }
    }
    free(b.arena);
    shots_free(&s);
}

TEST(cancelled)
{
    shots s = room_shots((const uint32_t[]){0, 2, 1}, 3);
    bench b = open_bench(3);
    t3r_scene scene;
    add_all(&b, &s);
    assert_int_equal(reconstruct(&b, &scene), T3R_OK);
    const uint64_t hash = b.hash;
    const int calls = b.calls;
    assert_true(calls >= 6); /* a look and a match per pair */
    for (b.cancel = 1; b.cancel <= calls; b.cancel++) {
        assert_int_equal(reconstruct(&b, &scene), T3R_ERR_CANCELLED);
        assert_int_equal(t3r_get_scene(b.rt, &scene), T3R_ERR_STATE);
    }
    b.cancel = 0;
    assert_int_equal(reconstruct(&b, &scene), T3R_OK);
    assert_int_equal(b.hash, hash);
    free(b.arena);
    shots_free(&s);
}

/* ---- refusals ---------------------------------------------------------------------------------------------------- */

static void expect_refusal(const shots *s, t3r_pair expected)
{
    bench b = open_bench(s->count);
    t3r_scene scene;
    add_all(&b, s);
    for (int turn = 0; turn < 2; turn++) { /* the views stay */
        assert_int_equal(reconstruct(&b, &scene), T3R_ERR_STEREO);
        assert_int_equal(t3r_get_scene(b.rt, &scene), T3R_ERR_STATE);
        for (uint32_t v = 0; v < s->count; v++) {
            uint32_t partner;
            const t3r_pair found = t3r_stereo_pair(b.rt, v, &partner);
            assert_int_equal(found, expected);
            assert_true(partner != v && partner < s->count);
        }
    }
    free(b.arena);
}

static void noise(uint8_t *rgb, uint64_t seed)
{
    for (int i = 0; i < 3 * PIXELS; i++) {
        rgb[i] = (uint8_t)(1 + unit_random(&seed) % 255);
    }
}

TEST(refused)
{
    shots s = room_shots((const uint32_t[]){0, 2, 4}, 3);
    const t3r_camera second = s.camera[1];
    s.count = 2;
    s.camera[1] = s.camera[0];
    expect_refusal(&s, T3R_PAIR_NO_BASELINE);
    s.camera[1].rotation_q30[2] += 1 << 28;
    expect_refusal(&s, T3R_PAIR_ROTATION);
    s.camera[1] = second;
    const int32_t *q = second.rotation_q30, turned[4] = {-q[2], -q[3], q[0], q[1]}; /* half a turn about its own y */
    memcpy(s.camera[1].rotation_q30, turned, sizeof turned);
    expect_refusal(&s, T3R_PAIR_OVERLAP);
    s.camera[1] = second;
    noise(s.rgb[1], 5);
    expect_refusal(&s, T3R_PAIR_OVERLAP);
    memset(s.rgb[1], 0, 3 * PIXELS); /* no contents */
    memset(s.rgb[2], 0, 3 * PIXELS);
    s.count = 3;
    expect_refusal(&s, T3R_PAIR_OVERLAP);

    bench b = open_bench(2);
    t3r_scene scene;
    uint32_t partner = 7;
    assert_int_equal(reconstruct(&b, &scene), T3R_ERR_STATE);
    add(&b, &s, 0, NULL, 0);
    assert_int_equal(reconstruct(&b, &scene), T3R_ERR_STATE);
    assert_int_equal(t3r_stereo_pair(b.rt, 0, &partner), T3R_PAIR_OK);
    assert_int_equal(partner, 0);
    assert_int_equal(t3r_stereo_pair(b.rt, 9, &partner), T3R_PAIR_OK);
    assert_int_equal(partner, 9);
    assert_int_equal(t3r_stereo_pair(NULL, 0, NULL), T3R_PAIR_OK);
    b.config.width = 31;
    assert_non_null(t3r_config_error(&b.config));
    b.config.depth = T3R_DEPTH_SENSOR;
    assert_null(t3r_config_error(&b.config));
    b.config.depth = T3R_DEPTH_COUNT;
    assert_non_null(t3r_config_error(&b.config));
    free(b.arena);
    s.count = 3;
    shots_free(&s);
}

/* ---- more views -------------------------------------------------------------------------------------------------- */

TEST(more_views)
{
    shots s = room_shots((const uint32_t[]){0, 1, 2, 3, 4}, 5);
    bench b = open_bench(5);
    t3r_scene scene;
    add_all(&b, &s);
    assert_int_equal(reconstruct(&b, &scene), T3R_OK);
    /* Ten pairs are compared, then matched: from part 10 on the best pairs, from 15 on others. */
    const uint32_t expected = 0x3ff | 3u << 10 | 1u << 15;
    assert_int_equal(b.told & expected, expected);
    for (uint32_t v = 0; v < 5; v++) {
        const verdict found = judge(&b, &s, v);
        uint32_t partner;
        assert_int_equal(t3r_stereo_pair(b.rt, v, &partner), T3R_PAIR_OK);
        print_message("view %u with %u: %u measured, %.1f %% of these off\n", v, partner, found.measured,
                      100 * found.wrong);
        assert_true(partner != v && found.measured > PIXELS / 2 && found.wrong < 0.15);
    }
    free(b.arena);
    shots_free(&s);
}

/* A view of another place has no depth and adds no points; the others are unaffected. */
TEST(a_stranger)
{
    shots s = room_shots((const uint32_t[]){0, 4, 2}, 3);
    bench b = open_bench(3);
    t3r_scene scene;
    noise(s.rgb[1], 9);
    add_all(&b, &s);
    assert_int_equal(reconstruct(&b, &scene), T3R_OK);
    uint32_t partner;
    assert_int_equal(t3r_stereo_pair(b.rt, 0, &partner), T3R_PAIR_OK);
    assert_int_equal(partner, 2);
    assert_int_equal(t3r_stereo_pair(b.rt, 2, &partner), T3R_PAIR_OK);
    assert_int_equal(partner, 0);
    assert_int_equal(t3r_stereo_pair(b.rt, 1, &partner), T3R_PAIR_OVERLAP);
    assert_int_equal(judge(&b, &s, 1).none, PIXELS);
    assert_int_equal(scene.count, BUDGET);
    for (uint32_t i = 0; i < scene.count; i++) {
        assert_int_not_equal(scene.gaussians[i].view, 1);
    }
    assert_true(judge(&b, &s, 0).measured > PIXELS / 2 && judge(&b, &s, 0).wrong < 0.15);
    free(b.arena);
    shots_free(&s);
}

/* ---- parts ------------------------------------------------------------------------------------------------------- */

TEST(fused)
{
    static const struct {
        uint16_t old_depth, new_depth;
        uint8_t old, new;
        uint16_t depth;
        uint8_t confidence;
    } cases[] = {
        {0, 0, 0, 0, 0, 0},               /* nothing */
        {1000, 0, 90, 0, 1000, 90},       /* nothing new */
        {0, 500, 0, 70, 1000, 70},        /* nothing old; units of 2 */
        {1000, 500, 60, 20, 1000, 80},    /* the same */
        {1000, 510, 60, 20, 1005, 80},    /* nearly: the mean weighted by confidence */
        {1000, 510, 200, 200, 1010, 255}, /* held to 255 */
        {1000, 700, 90, 30, 1000, 60},    /* another: the surer one, with less confidence */
        {1000, 700, 30, 90, 1400, 60},    /* */
        {1000, 700, 50, 50, 1000, 2},     /* of two equal ones the first, with little confidence */
        {1000, 700, 1, 2, 1400, 2},       /* matched wins over filled */
        {1000, 700, 2, 1, 1000, 2},       /* */
        {1000, 700, 1, 1, 1000, 1},       /* */
        {0, 700, 0, 1, 1400, 1},          /* */
        {1000, 40000, 90, 200, 1000, 90}, /* farther than 65,535 steps */
    };
    enum { COUNT = sizeof cases / sizeof *cases };
    uint16_t depth[COUNT], new_depth[COUNT];
    uint8_t confidence[COUNT], new_confidence[COUNT];
    for (int i = 0; i < COUNT; i++) {
        depth[i] = cases[i].old_depth;
        new_depth[i] = cases[i].new_depth;
        confidence[i] = cases[i].old;
        new_confidence[i] = cases[i].new;
    }
    const t3r_view view = {
        .width = COUNT, .height = 1, .depth = depth, .match_confidence = confidence, .depth_unit_q40 = 500};
    const t3r_view found = {
        .width = COUNT, .height = 1, .depth = new_depth, .match_confidence = new_confidence, .depth_unit_q40 = 1000};
    t3r_stereo_fuse(&view, &found);
    for (int i = 0; i < COUNT; i++) {
        assert_int_equal(depth[i], cases[i].depth);
        assert_int_equal(confidence[i], cases[i].confidence);
    }
}

/* Units as large and as different as possible. */
TEST(brought_together_at_any_scale)
{
    static const struct {
        uint64_t unit, new_unit;
        uint16_t depth;
        uint8_t confidence;
    } cases[] = {
        {UINT64_C(1) << 46, UINT64_C(1) << 46, 3000, 80},       /* the same step */
        {UINT64_C(1) << 45, (UINT64_C(1) << 46) - 4, 6000, 80}, /* twice as long */
        {UINT64_C(1) << 30, 1, 1000, 60},                       /* nearer than a step: left out */
        {1, UINT64_C(1) << 46, 1000, 60},                       /* farther than all steps */
        {UINT64_C(1) << 46, 1, 1000, 60},                       /* */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        uint16_t depth = i == 0 ? 3000 : i == 1 ? 6000 : 1000, new_depth = 3000;
        uint8_t confidence = 60, new_confidence = 20;
        const t3r_view view = {
            .width = 1, .height = 1, .depth = &depth, .match_confidence = &confidence, .depth_unit_q40 = cases[i].unit};
        const t3r_view found = {.width = 1,
                                .height = 1,
                                .depth = &new_depth,
                                .match_confidence = &new_confidence,
                                .depth_unit_q40 = cases[i].new_unit};
        t3r_stereo_fuse(&view, &found);
        assert_int_equal(depth, cases[i].depth);
        assert_int_equal(confidence, cases[i].confidence);
    }
}

/* A picture with a step of luma in the middle and a pixel with depth on either side: each side takes its own, even
 * if the other one is nearer. */
TEST(filled)
{
    enum { WIDTH = 16, HEIGHT = 9, COUNT = WIDTH * HEIGHT };
    uint8_t colour[COUNT], confidence[COUNT] = {0}, before[COUNT];
    uint16_t depth[COUNT] = {0};
    void *work = unit_array(T3R_SURROUNDINGS_BYTES_(WIDTH, HEIGHT) / 8 + 1, 8);
    const t3r_view view = {.width = WIDTH,
                           .height = HEIGHT,
                           .colour = {colour, colour, colour},
                           .depth = depth,
                           .match_confidence = confidence};
    for (int i = 0; i < COUNT; i++) {
        colour[i] = i % WIDTH < WIDTH / 2 ? 40 : 90;
    }
    colour[3] = 0;
    t3r_fill_surroundings(&view, T3R_FILLED, work); /* nothing to fill from */
    for (int i = 0; i < COUNT; i++) {
        assert_true(depth[i] == 0 && confidence[i] == T3R_STEREO_NONE);
    }
    const int left = 4 * WIDTH, right = 2 * WIDTH + WIDTH / 2;
    depth[left] = 100;
    depth[right] = 900;
    confidence[left] = 200;
    confidence[right] = 2;
    memcpy(before, confidence, sizeof before);
    t3r_fill_surroundings(&view, T3R_FILLED, work);
    for (int i = 0; i < COUNT; i++) {
        assert_int_equal(depth[i], i == 3 ? 0 : i % WIDTH < WIDTH / 2 ? 100 : 900);
        assert_int_equal(confidence[i], i == 3 ? T3R_STEREO_NONE : before[i] != 0 ? before[i] : T3R_STEREO_FILLED);
    }
    free(work);
}

/* In large pictures the sums over the steepest possible slope have more bits than a quotient can hold. */
TEST(extended_in_large_pictures)
{
    enum { WIDTH = 4096, HEIGHT = 480 };
    const size_t count = (size_t)WIDTH * HEIGHT;
    uint8_t *colour = unit_array(count, 1), *confidence = unit_array(count, 1);
    uint16_t *depth = unit_array(count, 2);
    void *work = unit_array(T3R_SURROUNDINGS_BYTES_(WIDTH, HEIGHT) / 8 + 1, 8);
    const t3r_view view = {.width = WIDTH,
                           .height = HEIGHT,
                           .colour = {colour, colour, colour},
                           .depth = depth,
                           .match_confidence = confidence};
    memset(colour, 128, count);
    for (size_t i = 0; i < count; i++) {
        const bool known = i % WIDTH % 64 < 40;
        depth[i] = (uint16_t)(known ? lround(64 * 480 / (479.5 - 0.9 * (double)(i / WIDTH))) : 0);
        confidence[i] = known ? 90 : T3R_STEREO_NONE;
    }
    t3r_fill_surroundings(&view, T3R_FILLED, work);
    for (size_t i = 0; i < count; i++) {
        const double truth = 64 * 480 / (479.5 - 0.9 * (double)(i / WIDTH));
        assert_true(fabs(depth[i] / truth - 1) < 0.03);
    }
    free(colour);
    free(confidence);
    free(depth);
    free(work);
}

/* Depths on a plane in the left half continue in the right half. */
TEST(extended)
{
    enum { WIDTH = 80, HEIGHT = 64, COUNT = WIDTH * HEIGHT };
    uint8_t colour[COUNT], confidence[COUNT];
    uint16_t depth[COUNT];
    uint64_t noise = 3;
    void *work = unit_array(T3R_SURROUNDINGS_BYTES_(WIDTH, HEIGHT) / 8 + 1, 8);
    const t3r_view view = {.width = WIDTH,
                           .height = HEIGHT,
                           .colour = {colour, colour, colour},
                           .depth = depth,
                           .match_confidence = confidence};
    memset(colour, 128, sizeof colour);
    for (int slant = -2; slant <= 2; slant++) {
        double most = 0;
        for (int i = 0; i < COUNT; i++) {
            const int known = i % WIDTH < WIDTH / 2 && unit_random(&noise) % 3 != 0;
            const double truth = 1 / (1e-4 * (1 + slant * 0.004 * (i % WIDTH - 40) + 0.003 * (i / WIDTH - 32)));
            depth[i] = (uint16_t)(known ? lround(truth) : 0);
            confidence[i] = known ? 90 : T3R_STEREO_NONE;
        }
        t3r_fill_surroundings(&view, T3R_FILLED, work);
        for (int i = 0; i < COUNT; i++) {
            const double truth = 1 / (1e-4 * (1 + slant * 0.004 * (i % WIDTH - 40) + 0.003 * (i / WIDTH - 32)));
            most = fmax(most, fabs(depth[i] / truth - 1));
        }
        print_message("slant %d: %.2f %%\n", slant, 100 * most);
        assert_true(most < 0.04);
    }
    /* So steep that the plane would end at the camera or behind it: twice or half of the last depth. */
    for (int sign = -1; sign <= 1; sign += 2) {
        for (int i = 0; i < COUNT; i++) {
            const int known = i % WIDTH < 20;
            depth[i] = (uint16_t)(known ? lround(1 / (1e-4 * (1 + sign * 0.04 * (i % WIDTH)))) : 0);
            confidence[i] = known ? 90 : T3R_STEREO_NONE;
        }
        t3r_fill_surroundings(&view, T3R_FILLED, work);
        const double last = 1 / (1e-4 * (1 + sign * 0.04 * 19));
        const double expected = fmin(sign < 0 ? 2 * last : last / 2, UINT16_MAX);
        assert_true(fabs(depth[WIDTH - 1] / expected - 1) < 0.01);
    }
    free(work);
}

/* The work memory of matching suffices for filling and its labels, for any shape. */
TEST(filling_fits)
{
    for (uint32_t w = T3R_STEREO_LEAST_SIDE; w <= T3R_MAX_SIDE; w += w < 300 ? 1 : 61) {
        for (uint32_t h = T3R_STEREO_LEAST_SIDE; h <= T3R_MAX_SIDE; h += h < 300 ? 1 : 61) {
            assert_true(T3R_PLANE_FILL_BYTES(w, h) <= T3R_STEREO_BYTES_(w, h, 2, 1));
        }
    }
}
