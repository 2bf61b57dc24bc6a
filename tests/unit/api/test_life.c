/* SPDX-License-Identifier: Apache-2.0 */
/* The life of a runtime: every call in every state has the outcome of life_table.h, and a refused one changes no byte
 * of the arena. With the variable T3R_TABLE the table is written to that file, as docs/firmware.md shows it. */
#include "unit/unit.h"

#include "life_table.h"
#include "rgbd_frame.h"
#include "sanitized_cpu.h"
#include "state/state.h"
#include "trim3r_heads.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE, BUDGET = 60, HALF = SIDE / 2 };

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[1 << 20], before[sizeof arena], copy[sizeof arena];
static size_t arena_bytes;
static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2], drawn[PIXELS * 3];
static uint16_t depth_out[PIXELS];
static t3r_runtime *rt;

static const t3r_scene_frame frame_of_scene;
static const t3r_gaussian faint = {.position_q20 = {0, 0, 1 << 20}, .factor = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

static t3r_frame some_frame(void)
{
    uint64_t seed = 3;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const uint32_t steps = 1500 + i % SIDE * 9;
        for (uint32_t c = 0; c < 3; c++) {
            rgb[3 * i + c] = (uint8_t)unit_random(&seed);
        }
        depth[2 * i] = (uint8_t)steps;
        depth[2 * i + 1] = (uint8_t)(steps >> 8);
    }
    return rgbd_frame(rgb, depth, SIDE, SIDE, MILLIMETRE_Q40);
}

static t3r_config config_of(life_kind kind)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, kind == DRAWING ? 0 : 2, BUDGET);
    config.max_gaussians = 2 * BUDGET;
    config.clusters = 6;
    config.refine = 1;
    config.keep_analysis = kind == KEEPING;
    config.warm = kind == WARM;
    config.stream = kind == STREAM;
    config.depth = kind == STEREO ? T3R_DEPTH_STEREO : T3R_DEPTH_SENSOR;
    return config;
}

static void open_runtime(life_kind kind)
{
    const t3r_config config = config_of(kind);
    size_t least;
    assert_int_equal(t3r_plan_bytes(&config, &least, &arena_bytes), T3R_OK);
    assert_true(arena_bytes <= sizeof arena);
    assert_int_equal(t3r_init(&rt, arena, arena_bytes, &config), T3R_OK);
    vectors_if_sanitized(rt);
}

/* ---- calls ------------------------------------------------------------------------------------------------------- */

static t3r_scene scene;

static t3r_status add_view(void)
{
    const t3r_frame frame = some_frame();
    const t3r_camera camera = straight_camera(SIDE);
    return t3r_add_view(rt, &frame, &camera);
}

static t3r_status add_half(uint32_t row)
{
    t3r_frame frame = some_frame();
    const t3r_camera camera = straight_camera(SIDE);
    frame.planes[0] += row * frame.stride_bytes[0];
    frame.depth += row * frame.depth_stride_bytes;
    return t3r_add_rows(rt, &frame, &camera, row, HALF, row, HALF);
}

static t3r_status first_rows(void)
{
    return add_half(0);
}

static t3r_status last_rows(void)
{
    return add_half(HALF);
}

static t3r_status develop(void)
{
    const t3r_frame frame = some_frame();
    const t3r_camera camera = straight_camera(SIDE);
    t3r_camera undistorted;
    return t3r_develop(rt, &frame, &camera, drawn, depth_out, &undistorted);
}

static t3r_status reconstruct(void)
{
    return t3r_reconstruct(rt, NULL, &scene);
}

static t3r_status rebuild(void)
{
    return t3r_rebuild(rt, NULL, &scene);
}

static t3r_status rebuild_least(void)
{
    const t3r_target target = {.width = SIDE, .height = SIDE, .rgb = drawn, .rgb_stride_bytes = 3 * SIDE};
    t3r_least found;
    return t3r_rebuild_least(rt, NULL, 20 * 256, &target, &scene, &found);
}

static t3r_status get_scene(void)
{
    return t3r_get_scene(rt, &scene);
}

static t3r_status render(void)
{
    const t3r_camera camera = straight_camera(SIDE);
    const t3r_target target = {.width = SIDE, .height = SIDE, .rgb = drawn, .rgb_stride_bytes = 3 * SIDE};
    return t3r_render(rt, &camera, &target);
}

static t3r_status begin(void)
{
    return t3r_scene_begin(rt, &frame_of_scene);
}

static t3r_status append(void)
{
    return t3r_scene_append(rt, &faint);
}

static t3r_status view_camera(void)
{
    t3r_camera camera;
    return t3r_view_camera(rt, 0, &camera);
}

static t3r_status view_gain(void)
{
    uint16_t gain_q14[3];
    return t3r_view_gain(rt, 0, gain_q14);
}

static t3r_status keyframe(void)
{
    const t3r_frame frame = some_frame();
    const t3r_camera camera = straight_camera(SIDE);
    return t3r_stream_keyframe(rt, &frame, &camera, NULL);
}

static t3r_status again(void)
{
    const t3r_frame frame = some_frame();
    const t3r_camera camera = straight_camera(SIDE);
    return t3r_stream_again(rt, &frame, &camera, 1);
}

static t3r_status overlap(void)
{
    const t3r_camera camera = straight_camera(SIDE);
    uint32_t overlap_q8;
    return t3r_stream_overlap(rt, &camera, SIDE, SIDE, &overlap_q8);
}

static t3r_status bind_head(void)
{
    return t3r_bind_head(rt, t3r_head_tiny, t3r_head_tiny_bytes);
}

static t3r_status set_hooks(void)
{
    const t3r_status status = t3r_set_cpu(rt, t3r_get_cpu(rt));
    return status == T3R_OK ? t3r_set_hooks(rt, NULL) : status;
}

static t3r_status reset(void)
{
    return t3r_reset(rt);
}

static t3r_status attach(void)
{
    memcpy(copy, arena, arena_bytes);
    memset(arena, 0, arena_bytes);
    memcpy(arena, copy, arena_bytes);
    return t3r_attach(&rt, arena, arena_bytes);
}

static t3r_status add_blind(void)
{
    t3r_frame frame = some_frame();
    const t3r_camera camera = straight_camera(SIDE);
    static const uint8_t unmeasured[sizeof depth];
    frame.depth = unmeasured;
    return t3r_add_view(rt, &frame, &camera);
}

static t3r_status add_folded(void)
{
    const t3r_frame frame = some_frame();
    t3r_camera folded = straight_camera(SIDE);
    folded.distortion = T3R_DISTORTION_RADTAN;
    folded.distortion_q24[0] = -(100 << 24);
    return t3r_add_view(rt, &frame, &folded);
}

static int cancel(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    (void)user;
    (void)stage;
    (void)done;
    (void)total;
    return 1;
}

/* Makes a call whose first piece of work is cancelled. */
static t3r_status cancelled(t3r_status (*call)(void))
{
    const t3r_hooks hooks = rt->hooks, cancelling = {.progress = cancel};
    assert_int_equal(t3r_set_hooks(rt, &cancelling), T3R_OK);
    const t3r_status status = call();
    assert_int_equal(t3r_set_hooks(rt, &hooks), T3R_OK);
    return status;
}

static t3r_status cancel_reconstruct(void)
{
    return cancelled(reconstruct);
}

static t3r_status cancel_rebuild(void)
{
    return cancelled(rebuild);
}

static t3r_status cancel_render(void)
{
    return cancelled(render);
}

#define FUNCTION(text, function, ...) function,
static t3r_status (*const calls[])(void) = {CALLS(FUNCTION)};

/* ---- states ------------------------------------------------------------------------------------------------------ */

static life_place place_now(void)
{
    if (rt->strips.rows != 0 || rt->strips.depth_rows != 0) {
        return PART;
    }
    if (rt->has_scene) {
        return rt->views > 0 ? BUILT : ALONE;
    }
    if (rt->config.keep_analysis && rt->analysed) {
        return ANALYSED;
    }
    return rt->views == 0 ? EMPTY : rt->views < rt->config.views ? VIEWS : FULL;
}

/* The calls that lead to each place, from an empty runtime; those of a stream to its map. */
static const int ways[PLACES][4] = {
    [EMPTY] = {CALL_COUNT},
    [PART] = {AT_add_view, AT_first_rows, CALL_COUNT},
    [VIEWS] = {AT_add_view, CALL_COUNT},
    [FULL] = {AT_add_view, AT_add_view, CALL_COUNT},
    [BUILT] = {AT_add_view, AT_add_view, AT_reconstruct, CALL_COUNT},
    [ANALYSED] = {AT_add_view, AT_add_view, AT_reconstruct, AT_cancel_rebuild},
    [ALONE] = {AT_begin, CALL_COUNT},
};
static const int way_of_stream[] = {AT_keyframe, CALL_COUNT};

static bool is_reached(life_kind kind, life_place place)
{
    switch (kind) {
    case KEEPING:
        return true;
    case STEREO:
        return place != BUILT && place != ANALYSED;
    case STREAM:
        return place == EMPTY || place == BUILT;
    case DRAWING:
        return place == EMPTY || place == ALONE;
    default:
        return place != ANALYSED;
    }
}

static void go_to(life_kind kind, life_place place)
{
    open_runtime(kind);
    const int *way = kind == STREAM && place == BUILT ? way_of_stream : ways[place];
    for (int i = 0; i < 4 && way[i] != CALL_COUNT; i++) {
        const t3r_status status = calls[way[i]]();
        assert_int_equal(status, way[i] == AT_cancel_rebuild ? T3R_ERR_CANCELLED : T3R_OK);
    }
    assert_int_equal(place_now(), place);
}

static life_outcome expected(life_kind kind, int call, life_place in)
{
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        if (others[i].kind == kind && others[i].call == call && others[i].in == in) {
            return others[i].outcome;
        }
    }
    return plain[call][in];
}

static bool is_refused(t3r_status status)
{
    return status == T3R_ERR_STATE || status == T3R_ERR_ARGUMENT;
}

TEST(every_call_in_every_state)
{
    for (life_kind kind = PLAIN; kind < KINDS; kind++) {
        for (life_place in = EMPTY; in < PLACES; in++) {
            for (int call = 0; call < CALL_COUNT && is_reached(kind, in); call++) {
                go_to(kind, in);
                memcpy(before, arena, arena_bytes);
                const life_outcome want = expected(kind, call, in);
                const t3r_status status = calls[call]();
                const life_place after = place_now();
                if (status != want.status || after != (want.after == HERE ? in : want.after)) {
                    fail_msg("%s %s in %s: status %d and %s", kind_texts[kind], call_texts[call], place_names[in],
                             (int)status, place_names[after]);
                }
                if (is_refused(status) && memcmp(before, arena, arena_bytes) != 0) {
                    fail_msg("%s %s in %s: refused, but the arena changed", kind_texts[kind], call_texts[call],
                             place_names[in]);
                }
            }
        }
    }
}

/* Every difference is one: no row of the second table repeats the first. */
TEST(differences_differ)
{
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        const life_outcome usual = plain[others[i].call][others[i].in], other = others[i].outcome;
        const bool same_place =
            (usual.after == HERE ? others[i].in : usual.after) == (other.after == HERE ? others[i].in : other.after);
        assert_true(usual.status != other.status || !same_place);
        assert_true(is_reached(others[i].kind, others[i].in));
    }
}

/* ---- the table of docs/firmware.md ---------------------------------------------------------------------------------
 */

static const char *text_of(life_outcome outcome, life_place in)
{
    return is_refused(outcome.status) ? "–" : place_names[outcome.after == HERE ? in : outcome.after];
}

TEST(table)
{
    const char *path = getenv("T3R_TABLE");
    if (path == NULL) {
        return;
    }
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "| in the state: |");
    for (life_place in = EMPTY; in < PLACES; in++) {
        fprintf(file, " %s |", place_names[in]);
    }
    fprintf(file, "\n|---|---|---|---|---|---|---|---|\n");
    for (int call = 0; call < CALL_COUNT; call++) {
        fprintf(file, "| %s |", call_texts[call]);
        for (life_place in = EMPTY; in < PLACES; in++) {
            fprintf(file, " %s |", text_of(plain[call][in], in));
        }
        fprintf(file, "\n");
    }
    fprintf(file, "\nSettings change these rows:\n\n| with | call | state before and after |\n|---|---|---|\n");
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        const bool goes_on = i > 0 && others[i].kind == others[i - 1].kind && others[i].call == others[i - 1].call;
        if (!goes_on) {
            fprintf(file, "%s| %s | %s |", i > 0 ? " |\n" : "", kind_texts[others[i].kind], call_texts[others[i].call]);
        }
        fprintf(file, "%s %s → %s", goes_on ? ";" : "", place_names[others[i].in],
                text_of(others[i].outcome, others[i].in));
    }
    fprintf(file, " |\n");
    assert_int_equal(fclose(file), 0);
}
