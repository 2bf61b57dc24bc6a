/* SPDX-License-Identifier: Apache-2.0 */
/* The gate of a stream in the built-in room: honest frames pass, each trouble is refused for its reason and leaves no
 * trace, and what lasts is taken in the end. */
#include "unit/unit.h"

#include "rgbd_frame.h"
#include "room/room.h"
#include "state/state.h"
#include "stream/stream_gate.h"
#include "stream/stream_map.h"

enum { W = 64, H = 48, PIXELS = W * H, CAP = 1500, LIVE = 3, STRIDE = 3, FIRST = 8 };

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[4 << 20], before[4 << 20];
static size_t arena_bytes;
static uint8_t rgb[PIXELS * 3];
static uint16_t depth[PIXELS];
static t3r_camera camera;

static t3r_runtime *begin_with(uint32_t live, uint32_t gate, uint32_t align)
{
    t3r_config config = t3r_default_config(W, H, live, CAP);
    config.stream = 1;
    config.refine = 1;
    config.fit_passes = 0;
    config.remember = 2;
    config.gate = gate;
    config.align = align;
    t3r_runtime *rt;
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(&config, &plan), T3R_OK);
    assert_true(plan.bytes <= sizeof arena);
    arena_bytes = plan.bytes;
    assert_int_equal(t3r_init(&rt, arena, plan.bytes, &config), T3R_OK);
    return rt;
}

static t3r_runtime *begin(uint32_t gate)
{
    return begin_with(LIVE, gate, 1);
}

static void look(uint32_t frame)
{
    room_frame(frame, W, H, 1, rgb, depth);
    room_camera(frame, W, H, &camera);
}

static t3r_status take(t3r_runtime *rt, t3r_stream_report *report)
{
    t3r_frame frame = rgbd_frame(rgb, (const uint8_t *)depth, W, H, MILLIMETRE_Q40);
    return t3r_stream_keyframe(rt, &frame, &camera, report);
}

/* Takes honest keyframes `first` to `end` - 1 of the path. */
static void walk(t3r_runtime *rt, uint32_t first, uint32_t end)
{
    for (uint32_t i = first; i < end; i++) {
        t3r_stream_report report;
        look(i * STRIDE);
        assert_int_equal(take(rt, &report), T3R_OK);
        assert_int_equal(report.refusal, T3R_REFUSAL_NONE);
        assert_int_equal(report.moved + report.realigned, 0);
        assert_int_equal(report.keyframes, rt->keyframes);
    }
}

/* ---- troubles ---- */

static void scale(uint32_t part, uint32_t of)
{
    for (uint32_t i = 0; i < sizeof rgb; i++) {
        const uint32_t level = rgb[i] * part / of;
        rgb[i] = (uint8_t)(level < 255 ? level : 255);
    }
}

static void black(void)
{
    scale(0, 1);
}

static void dark(void)
{
    scale(1, 8);
}

static void white(void)
{
    memset(rgb, 255, sizeof rgb);
}

static void blind(void)
{
    memset(depth, 0, sizeof depth);
}

/* A hand covers all but the leftmost columns. */
static void cover(uint16_t mm)
{
    for (uint32_t i = 0; i < PIXELS; i++) {
        if (i % W >= W / 8) {
            rgb[3 * i] = (uint8_t)(190 + i % W / 8);
            rgb[3 * i + 1] = (uint8_t)(140 + i / W / 8);
            rgb[3 * i + 2] = 120;
            depth[i] = mm;
        }
    }
}

static void hand(void)
{
    cover(150);
}

static void blind_hand(void)
{
    cover(0);
}

/* Depth is lost in three quarters of the picture. */
static void glare(void)
{
    for (uint32_t i = 0; i < PIXELS; i++) {
        depth[i] = i % W < W / 4 ? depth[i] : 0;
    }
}

/* The lens is shifted so far to the right that three eighths of the picture are left. */
static void aside(void)
{
    enum { KEPT = W * 3 / 8, OFF = W - KEPT };
    camera.cx_q16 -= OFF << 16;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const bool kept = i % W < KEPT;
        depth[i] = kept ? depth[i + OFF] : 0;
        for (uint32_t c = 0; c < 3 && kept; c++) {
            rgb[3 * i + c] = rgb[3 * (i + OFF) + c];
        }
    }
}

/* Something is between the camera and all that the map has. */
static void nearer(void)
{
    for (uint32_t i = 0; i < PIXELS; i++) {
        depth[i] /= 2;
    }
}

enum { JUMP_MM = 700 };

static void jump(void)
{
    camera.position_q32[0] += ((int64_t)JUMP_MM << 32) / 1000;
}

static void jump_back(void)
{
    camera.position_q32[0] -= ((int64_t)JUMP_MM << 32) / 1000;
}

static void absurd(void)
{
    camera.position_q32[2] += (int64_t)1000000 << 32;
}

static void blur(void)
{
    for (uint32_t pass = 0; pass < 12; pass++) {
        for (uint32_t i = 0; i + 1 < PIXELS; i++) {
            for (uint32_t c = 0; c < 3; c++) {
                rgb[3 * i + c] = (uint8_t)((rgb[3 * i + c] + rgb[3 * i + 3 + c]) / 2);
            }
        }
    }
}

static const struct {
    const char *name;
    void (*apply)(void);
    t3r_refusal refusal;
} troubles[] = {
    {"black", black, T3R_REFUSAL_DARK},      {"white", white, T3R_REFUSAL_BRIGHT},
    {"dark", dark, T3R_REFUSAL_EXPOSURE},    {"blind", blind, T3R_REFUSAL_NO_DEPTH},
    {"hand", hand, T3R_REFUSAL_COVERED},     {"blind hand", blind_hand, T3R_REFUSAL_COVERED},
    {"jump", jump, T3R_REFUSAL_CONTRADICTS}, {"absurd", absurd, T3R_REFUSAL_FAR},
    {"blur", blur, T3R_REFUSAL_BLURRED},
};
enum { TROUBLES = sizeof troubles / sizeof *troubles };

/* ---- tests ---- */

TEST(honest_frames_pass)
{
    t3r_runtime *rt = begin(1);
    walk(rt, 0, 2 * 70 / STRIDE);
}

/* The picture still shows the map where depth is lost, and a frame may show little of what was seen last. */
TEST(frames_that_say_little_pass)
{
    t3r_runtime *rt = begin(1);
    t3r_stream_report report;
    walk(rt, 0, FIRST);
    look(FIRST * STRIDE);
    glare();
    assert_int_equal(take(rt, &report), T3R_OK);
    assert_true(report.refusal == T3R_REFUSAL_NONE && report.hidden_q8 > 160 && report.hidden_likeness_q8 > 80);
    rt = begin(1);
    walk(rt, 0, FIRST);
    look(FIRST * STRIDE);
    aside();
    assert_int_equal(take(rt, &report), T3R_OK);
    assert_true(report.refusal == T3R_REFUSAL_NONE && report.recent > 32 && report.in_view_q8 < 128);
}

/* Gaussians of one colour have no likeness, and grey pictures no detail; the ratio of levels has a bound. */
TEST(grey_rooms)
{
    enum { LEVEL = 16 };
    t3r_runtime *rt = begin(1);
    t3r_stream_report report;
    for (uint32_t i = 0; i < FIRST; i++) {
        look(i * STRIDE);
        memset(rgb, LEVEL, sizeof rgb);
        assert_int_equal(take(rt, &report), T3R_OK);
        assert_true(report.refusal == T3R_REFUSAL_NONE && report.likeness_q8 == 256 && report.detail_q8 == 0);
    }
    const t3r_map map = t3r_map_of(rt);
    for (uint32_t i = 0; i < map.count; i++) {
        map.gaussians[i].colour_q7[1] = LEVEL * 128;
    }
    look(FIRST * STRIDE);
    white();
    assert_int_equal(take(rt, &report), T3R_OK);
    assert_int_equal(report.refusal, T3R_REFUSAL_BRIGHT);
    assert_int_equal(report.exposure_q8, 4 * (T3R_RATIO_BINS / 2 - 1));
}

/* Stripes as wide as half the reach of coarse differences have the most detail. */
TEST(fine_stripes)
{
    t3r_runtime *rt = begin(1);
    t3r_stream_report report;
    look(0);
    for (uint32_t i = 0; i < sizeof rgb; i++) {
        rgb[i] = i / 3 % W == W - 1 ? 100 : i / 3 % 4 < 2 ? 40 : 200;
    }
    assert_int_equal(take(rt, &report), T3R_OK);
    assert_int_equal(report.detail_q8, 1024);
}

/* Whether everything that later keyframes use is as it was: the map, the keyframes and their state. */
static bool is_as_before(const t3r_runtime *rt)
{
    static const enum t3r_buffer lasting[] = {T3R_BUFFER_MAP_RECORDS, T3R_BUFFER_REMEMBERED, T3R_BUFFER_COLOUR,
                                              T3R_BUFFER_DEPTH,       T3R_BUFFER_VALIDITY,   T3R_BUFFER_SCENE};
    t3r_runtime now = *rt;
    now.gate = ((const t3r_runtime *)(const void *)before)->gate; /* its own memory is all that may change */
    bool same = memcmp(&now, before, sizeof now) == 0;
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(&rt->config, &plan), T3R_OK);
    for (size_t i = 0; i < sizeof lasting / sizeof *lasting; i++) {
        const size_t at = (size_t)rt->offset[lasting[i]];
        same = same && memcmp(arena + at, before + at, plan.buffers[lasting[i]].bytes) == 0;
    }
    return same;
}

TEST(a_refused_frame_leaves_no_trace)
{
    for (size_t i = 0; i < TROUBLES; i++) {
        t3r_runtime *rt = begin(1);
        walk(rt, 0, FIRST);
        memcpy(before, arena, arena_bytes);
        t3r_stream_report report;
        look(FIRST * STRIDE);
        troubles[i].apply();
        assert_int_equal(take(rt, &report), T3R_OK);
        if (report.refusal != troubles[i].refusal) {
            fail_msg("%s: %s", troubles[i].name, t3r_refusal_name(report.refusal));
        }
        assert_true(report.keyframes == FIRST && report.gaussians == rt->gaussians && report.added == 0 &&
                    report.points == 0);
        assert_true(is_as_before(rt));
        walk(rt, FIRST, FIRST + LIVE + 2);
    }
}

/* A frame without a depth plane is refused, too; without the gate it is an error, which leaves no trace either. */
TEST(without_a_gate)
{
    for (uint32_t gate = 0; gate < 2; gate++) {
        t3r_runtime *rt = begin(gate);
        walk(rt, 0, FIRST);
        memcpy(before, arena, arena_bytes);
        t3r_stream_report report;
        look(FIRST * STRIDE);
        t3r_frame frame = rgbd_frame(rgb, NULL, W, H, MILLIMETRE_Q40);
        assert_int_equal(t3r_stream_keyframe(rt, &frame, &camera, &report), gate ? T3R_OK : T3R_ERR_NO_DEPTH);
        assert_int_equal(report.refusal, gate ? T3R_REFUSAL_NO_DEPTH : T3R_REFUSAL_NONE);
        blind();
        assert_int_equal(take(rt, &report), gate ? T3R_OK : T3R_ERR_NO_DEPTH);
        look(FIRST * STRIDE);
        absurd();
        assert_int_equal(take(rt, &report), gate ? T3R_OK : T3R_ERR_CAMERA);
        assert_true(is_as_before(rt));
        look(FIRST * STRIDE);
        black();
        assert_int_equal(take(rt, &report), T3R_OK);
        assert_int_equal(report.keyframes, FIRST + !gate);
    }
}

/* A reason that may last holds off a number of frames. The next one is taken, into the same piece of the map. */
TEST(lasting_troubles_are_taken)
{
    static const struct {
        void (*apply)(void);
        t3r_refusal refusal;
        uint32_t align, refused;
    } lasting[] = {{blur, T3R_REFUSAL_BLURRED, 1, 4},
                   {dark, T3R_REFUSAL_EXPOSURE, 1, 16},
                   {hand, T3R_REFUSAL_COVERED, 1, 32},
                   {nearer, T3R_REFUSAL_CONTRADICTS, 0, 4},
                   {nearer, T3R_REFUSAL_CONTRADICTS, 1, 4}};
    for (size_t t = 0; t < sizeof lasting / sizeof *lasting; t++) {
        t3r_runtime *rt = begin_with(LIVE, 1, lasting[t].align);
        walk(rt, 0, FIRST);
        for (uint32_t i = 0; i <= lasting[t].refused; i++) {
            t3r_stream_report report;
            look(FIRST * STRIDE);
            lasting[t].apply();
            assert_int_equal(take(rt, &report), T3R_OK);
            assert_int_equal(report.refusal, i < lasting[t].refused ? lasting[t].refusal : T3R_REFUSAL_NONE);
            assert_int_equal(report.moved + report.realigned, 0);
        }
    }
}

/* Frames that contradict the map before the map may move with poses, and before one of another place is taken. */
enum { REFUSED_OF_JUMP = 2, REFUSED = 4 };

/* Takes frames that contradict the map until one is taken, after so many. */
static void take_contradicting(t3r_runtime *rt, void (*apply)(void), uint32_t refused, t3r_stream_report *report)
{
    for (uint32_t i = 0; i <= refused; i++) {
        look((FIRST + i) * STRIDE);
        apply();
        memcpy(before, arena, arena_bytes);
        assert_int_equal(take(rt, report), T3R_OK);
        assert_int_equal(report->refusal, i < refused ? T3R_REFUSAL_CONTRADICTS : T3R_REFUSAL_NONE);
        assert_true(i == refused || is_as_before(rt)); /* also where the map might have moved */
    }
}

static void walk_on(t3r_runtime *rt, void (*apply)(void))
{
    for (uint32_t i = REFUSED + 1; i < REFUSED + 6; i++) {
        t3r_stream_report report;
        look((FIRST + i) * STRIDE);
        apply();
        assert_int_equal(take(rt, &report), T3R_OK);
        assert_int_equal(report.refusal, T3R_REFUSAL_NONE);
        assert_int_equal(report.moved + report.realigned, 0);
    }
}

static uint8_t drawn[2][PIXELS * 3];

static void draw(t3r_runtime *rt, uint8_t *picture)
{
    const t3r_target target = {.width = W, .height = H, .rgb = picture, .rgb_stride_bytes = W * 3};
    assert_int_equal(t3r_render(rt, &camera, &target), T3R_OK);
}

/* After poses that jump, the map moves with them: it looks from the new poses as it did from the old ones. */
TEST(a_lasting_jump_moves_the_map)
{
    t3r_runtime *rt = begin(1);
    walk(rt, 0, FIRST);
    look((FIRST - 1) * STRIDE);
    draw(rt, drawn[0]);
    t3r_stream_report report;
    take_contradicting(rt, jump, REFUSED_OF_JUMP, &report);
    assert_true(report.moved == 0 && report.realigned == 1 && report.removed < CAP / 50);
    assert_true(rt->remembered > 0);
    look((FIRST - 1) * STRIDE);
    jump();
    draw(rt, drawn[1]);
    uint64_t squares = 0;
    for (uint32_t i = 0; i < sizeof drawn[0]; i++) {
        const int32_t off = drawn[0][i] - drawn[1][i];
        squares += (uint64_t)(off * off);
    }
    assert_true(squares < 32 * sizeof drawn[0]); /* 33 dB */
    walk_on(rt, jump);
}

static void jump_with_holes(void)
{
    jump();
    for (uint32_t i = 0; i < PIXELS; i += 3) {
        depth[i] = 0;
    }
}

static int cancel_alignment(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    (void)user;
    (void)done;
    (void)total;
    return stage == T3R_STAGE_POINTMAP;
}

/* A frame that is cancelled while it is aligned leaves no trace, and the same frame then moves the map. */
TEST(a_jump_that_is_cancelled)
{
    t3r_runtime *rt = begin(1);
    t3r_stream_report report;
    walk(rt, 0, FIRST + 1); /* the frame's slot is between those of other keyframes */
    for (uint32_t i = 1; i <= REFUSED_OF_JUMP + 2; i++) {
        const bool cancelled = i == REFUSED_OF_JUMP + 1;
        const t3r_hooks hooks = {.progress = cancelled ? cancel_alignment : NULL};
        look((FIRST + T3R_MIN(i, REFUSED_OF_JUMP + 1u)) * STRIDE);
        jump_with_holes();
        assert_int_equal(t3r_set_hooks(rt, &hooks), T3R_OK);
        memcpy(before, arena, arena_bytes);
        assert_int_equal(take(rt, &report), cancelled ? T3R_ERR_CANCELLED : T3R_OK);
        assert_true(i == REFUSED_OF_JUMP + 2 || is_as_before(rt));
    }
    assert_true(report.refusal == T3R_REFUSAL_NONE && report.realigned == 1);
}

/* Places where a copied arena may say that the jump began. */
static void nowhere(const t3r_runtime *rt, t3r_placement *from)
{
    (void)rt;
    *from = (t3r_placement){.position_q32 = {(int64_t)1000000 << 32}};
}

/* The camera turned about the vertical axis, so far away that the frame is at the edge of the map's range: the grid of
 * guesses begins beyond it. Without the turn the frame is beyond it. */
static void edge(const t3r_runtime *rt, t3r_placement *from)
{
    const t3r_camera *last = &rt->camera[(rt->next_slot + LIVE - 1) % LIVE];
    const int32_t *q = last->rotation_q30;
    const int64_t unit_q32 = INT64_C(1) << (32 + rt->frame.exponent);
    *from = (t3r_placement){.rotation_q30 = {-q[2], q[3], q[0], -q[1]}};
    memcpy(from->position_q32, camera.position_q32, sizeof from->position_q32);
    from->position_q32[0] += rt->frame.origin_q32[0] - last->position_q32[0] - (1024 * unit_q32 - unit_q32 / 64);
}

/* A frame whose jump cannot be followed begins a new piece, as without alignment. */
TEST(jumps_from_anywhere)
{
    void (*const places[])(const t3r_runtime *, t3r_placement *) = {nowhere, edge};
    for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
        t3r_runtime *rt = begin(1);
        t3r_stream_report report;
        walk(rt, 0, FIRST);
        for (uint32_t i = 0; i <= REFUSED; i++) {
            look((FIRST + i) * STRIDE);
            jump();
            places[p](rt, &rt->gate.contradicts_from);
            memcpy(before, arena, arena_bytes);
            assert_int_equal(take(rt, &report), T3R_OK);
            assert_int_equal(report.refusal, i < REFUSED ? T3R_REFUSAL_CONTRADICTS : T3R_REFUSAL_NONE);
            assert_true(i == REFUSED || is_as_before(rt));
        }
        assert_true(report.moved == 1 && report.realigned == 0);
    }
}

/* Figures from another pose agree if there are enough of them, they are good, and clearly better than those before. */
TEST(figures_that_agree)
{
    const t3r_stream_report good = {.compared = 32, .recent = 256, .in_view_q8 = 256, .likeness_q8 = 156};
    t3r_stream_report other = {.compared = 200, .recent = 256, .in_view_q8 = 256, .likeness_q8 = 256 - 134},
                      figures = good;
    assert_true(t3r_gate_agrees(&good, &other));
    other.likeness_q8++; /* 133, and 100 is more than 3/4 of it */
    assert_false(t3r_gate_agrees(&good, &other));
    other.compared = 31; /* the frame missed the map from there */
    assert_true(t3r_gate_agrees(&good, &other));
    figures.likeness_q8 = 256 - 243;
    assert_true(t3r_gate_agrees(&figures, &other));
    figures.likeness_q8--;
    assert_false(t3r_gate_agrees(&figures, &other));
    figures = good;
    figures.contradicted_q8 = 35; /* 4 times 35, and 100, is 240 */
    assert_true(t3r_gate_agrees(&figures, &other));
    figures.contradicted_q8++;
    assert_false(t3r_gate_agrees(&figures, &other));
    figures = good;
    figures.compared--;
    assert_false(t3r_gate_agrees(&figures, &other));
    figures = good;
    figures.recent++;
    assert_false(t3r_gate_agrees(&figures, &other));
    figures.in_view_q8 = 127;
    assert_true(t3r_gate_agrees(&figures, &other));
}

/* Without alignment, or another live keyframe to align with, a new piece begins: what the new frames cover and do not
 * show leaves the map. */
TEST(a_lasting_jump_begins_a_new_piece)
{
    for (uint32_t align = 0; align < 2; align++) {
        t3r_runtime *rt = begin_with(align ? 1 : LIVE, 1, align);
        walk(rt, 0, FIRST);
        t3r_stream_report report;
        take_contradicting(rt, jump, REFUSED, &report);
        assert_true(report.moved == 1 && report.realigned == 0);
        assert_true(report.removed > CAP / 4 && rt->remembered == 0);
        walk_on(rt, jump);
    }
}

/* Poses that jump elsewhere before the map may move, or that come back, move nothing. */
TEST(jumps_that_do_not_last)
{
    t3r_runtime *rt = begin(1);
    walk(rt, 0, FIRST);
    for (uint32_t i = 0; i <= 2 * REFUSED_OF_JUMP; i++) {
        t3r_stream_report report;
        look(FIRST * STRIDE);
        (i == REFUSED_OF_JUMP ? jump_back : jump)();
        memcpy(before, arena, arena_bytes);
        assert_int_equal(take(rt, &report), T3R_OK);
        assert_int_equal(report.refusal, T3R_REFUSAL_CONTRADICTS);
        assert_true(is_as_before(rt));
    }
    walk(rt, FIRST, FIRST + LIVE + 2);
}

/* A room of the same shape that has none of the colours. */
static void inverted(void)
{
    for (uint32_t i = 0; i < sizeof rgb; i++) {
        rgb[i] = (uint8_t)(255 - rgb[i]);
    }
}

TEST(another_place_begins_a_new_piece)
{
    t3r_runtime *rt = begin(1);
    walk(rt, 0, FIRST);
    t3r_stream_report report;
    take_contradicting(rt, inverted, REFUSED, &report);
    assert_true(report.moved == 1 && report.realigned == 0);
    walk_on(rt, inverted);
}

/* Poses that jump about are no path. */
TEST(wild_poses_are_never_taken)
{
    t3r_runtime *rt = begin(1);
    walk(rt, 0, FIRST);
    for (uint32_t i = 0; i < 12; i++) {
        t3r_stream_report report;
        look(FIRST * STRIDE);
        (i % 2 == 0 ? jump : jump_back)();
        assert_int_equal(take(rt, &report), T3R_OK);
        assert_int_equal(report.refusal, T3R_REFUSAL_CONTRADICTS);
    }
}
