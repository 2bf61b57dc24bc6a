/* SPDX-License-Identifier: Apache-2.0 */
/* Errors in words: each cause is made, and the function of the call's name with the suffix _error gives it a sentence
 * of its own. With the variable T3R_TABLE all are written to that file, as docs/errors.md shows them. */
#include "unit/unit.h"

#include "rgbd_frame.h"
#include "state/state.h"
#include "trim3r_heads.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE, BUDGET = 60, MOST_ROWS = 180, CUT = 10 };

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[1 << 20], before[sizeof arena];
static size_t arena_bytes;
static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2], picture[PIXELS * 3];
static _Alignas(4) uint32_t picture_depth[PIXELS + 1];
static uint16_t picture_alpha[PIXELS + 1], plane[PIXELS + 1];
static const uint16_t *planes[] = {plane, plane};

/* The arguments of the calls below, good until a case damages one of them. */
static t3r_runtime *rt;
static t3r_config config;
static t3r_frame frame;
static t3r_camera camera, undistorted;
static t3r_target target;
static t3r_request request;
static t3r_scene_frame scene_frame;
static t3r_gaussian gaussian;
static t3r_scene scene;
static t3r_stream_report report;
static uint32_t overlap_q8;

/* ---- the table -----------------------------------------------------------------------------------------------------
 */

static struct {
    const char *cause, *call;
    t3r_status status;
    char sentence[T3R_ERROR_BYTES];
} rows[MOST_ROWS];
static size_t row_count;

/* Checks a sentence, and adds it to the table. */
static void note(const char *cause, const char *call, t3r_status want, t3r_status got, const char *sentence)
{
    if (got != want || strcmp(sentence, t3r_error_text(got)) == 0 || strlen(sentence) + 1 >= T3R_ERROR_BYTES) {
        fail_msg("%s: status %d, wanted %d: %s", cause, (int)got, (int)want, sentence);
    }
    for (size_t i = 0; i < row_count; i++) {
        if (strcmp(rows[i].sentence, sentence) == 0) {
            fail_msg("%s, and %s: %s", rows[i].cause, cause, sentence);
        }
    }
    assert_true(row_count < MOST_ROWS);
    rows[row_count].cause = cause;
    rows[row_count].call = call;
    rows[row_count].status = got;
    memcpy(rows[row_count++].sentence, sentence, strlen(sentence) + 1);
}

/* A sentence changes no byte of the arena, and is cut to its memory. */
#define SAID(cause, call, want, status, ...)                                                                           \
    do {                                                                                                               \
        char text[T3R_ERROR_BYTES], cut[CUT + 1] = {[CUT] = 'x'};                                                      \
        memcpy(before, arena, sizeof arena);                                                                           \
        note(cause, #call, want, status, call##_error(status, __VA_ARGS__, text, sizeof text));                        \
        (void)call##_error(status, __VA_ARGS__, cut, CUT);                                                             \
        assert_memory_equal(before, arena, sizeof arena);                                                              \
        assert_true(strlen(cut) == CUT - 1 && cut[CUT] == 'x' && strncmp(cut, text, CUT - 1) == 0);                    \
        assert_string_equal(call##_error(status, __VA_ARGS__, NULL, CUT), t3r_error_text(status));                     \
        assert_string_equal(call##_error(status, __VA_ARGS__, cut, 0), t3r_error_text(status));                        \
    } while (0)

/* The call is refused for this cause. */
#define REFUSED(cause, want, call, ...)                                                                                \
    do {                                                                                                               \
        const t3r_status status_ = call(__VA_ARGS__);                                                                  \
        SAID(cause, call, want, status_, __VA_ARGS__);                                                                 \
    } while (0)

/* The call is refused for a cause that it shares with others, in the same words. */
#define REFUSED_TOO(words, want, call, ...)                                                                            \
    do {                                                                                                               \
        char text_[T3R_ERROR_BYTES];                                                                                   \
        const t3r_status status_ = call(__VA_ARGS__);                                                                  \
        assert_int_equal(status_, want);                                                                               \
        assert_non_null(strstr(call##_error(status_, __VA_ARGS__, text_, sizeof text_), words));                       \
    } while (0)

/* ---- a runtime and good arguments ----------------------------------------------------------------------------------
 */

static void good_arguments(void)
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
    frame = rgbd_frame(rgb, depth, SIDE, SIDE, MILLIMETRE_Q40);
    camera = straight_camera(SIDE);
    target = (t3r_target){.width = SIDE,
                          .height = SIDE,
                          .rgb = picture,
                          .rgb_stride_bytes = 3 * SIDE,
                          .depth_q20 = picture_depth,
                          .depth_stride_bytes = 4 * SIDE,
                          .alpha_q15 = picture_alpha,
                          .alpha_stride_bytes = 2 * SIDE};
    request = (t3r_request){0};
    scene_frame = (t3r_scene_frame){0};
    gaussian = (t3r_gaussian){.position_q20 = {0, 0, 1 << 20}, .factor = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
}

static void good_config(void)
{
    good_arguments();
    config = t3r_default_config(SIDE, SIDE, 2, BUDGET);
    config.clusters = 6;
    config.refine = 1;
}

static void open_runtime(void)
{
    size_t least;
    assert_int_equal(t3r_plan_bytes(&config, &least, &arena_bytes), T3R_OK);
    assert_true(arena_bytes <= sizeof arena);
    assert_int_equal(t3r_init(&rt, arena, arena_bytes, &config), T3R_OK);
}

static void empty(void)
{
    good_config();
    open_runtime();
}

static void empty_with(size_t setting, uint32_t value)
{
    good_config();
    memcpy((uint8_t *)&config + setting, &value, sizeof value);
    open_runtime();
}
#define WITH(setting, value) empty_with(offsetof(t3r_config, setting), (value))

static void add(uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(t3r_add_view(rt, &frame, &camera), T3R_OK);
    }
}

static void build(void)
{
    add(1);
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
}

/* ---- causes --------------------------------------------------------------------------------------------------------
 */

TEST(settings)
{
    t3r_plan_info plan;
    size_t least, bytes;
    good_config();
    REFUSED("no configuration", T3R_ERR_ARGUMENT, t3r_plan, NULL, &plan);
    REFUSED("no place for the plan", T3R_ERR_ARGUMENT, t3r_plan, &config, NULL);
    REFUSED("no place for the sums", T3R_ERR_ARGUMENT, t3r_plan_bytes, &config, &least, NULL);
    config.width = 4;
    REFUSED("a working size below 8", T3R_ERR_CONFIG, t3r_plan, &config, &plan);
    good_config();
    config.gaussians = 500;
    REFUSED("a budget above max_gaussians", T3R_ERR_CONFIG, t3r_plan, &config, &plan);
    good_config();
    config.head = T3R_HEAD_COUNT;
    REFUSED("a head that is not there", T3R_ERR_CONFIG, t3r_plan_bytes, &config, &least, &bytes);
    good_config();
    config.depth = T3R_DEPTH_STEREO;
    config.stream = 1;
    REFUSED("a stream with depth by stereo", T3R_ERR_CONFIG, t3r_plan, &config, &plan);
    good_config();
    REFUSED("too little memory for one Gaussian", T3R_ERR_ARENA, t3r_plan_within, 5000, &config);
    config.gaussians = 0;
    REFUSED("a budget of 0", T3R_ERR_CONFIG, t3r_plan_within, 50000, &config);
    REFUSED("a preset that is not there", T3R_ERR_ARGUMENT, t3r_set_preset, T3R_PRESET_COUNT, &config, NULL);
    REFUSED_TOO("config is NULL", T3R_ERR_ARGUMENT, t3r_set_preset, T3R_PRESET_FAST, NULL, NULL);
    (void)t3r_default_config_as(t3r_header_interface() + 1, &config, sizeof config, SIDE, SIDE, 1, 1);
    REFUSED("a configuration of another trim3r.h", T3R_ERR_CONFIG, t3r_plan, &config, &plan);
    assert_string_equal(t3r_config_error(&config), rows[row_count - 1].sentence);
}

TEST(arenas)
{
    good_config();
    REFUSED("a program with another trim3r.h", T3R_ERR_INTERFACE, t3r_init_as, ~t3r_header_interface(), &rt, arena,
            sizeof arena, &config);
    REFUSED("a program without stereo and streams", T3R_ERR_INTERFACE, t3r_init_as,
            t3r_header_interface() ^ (T3R_HAS_STEREO | T3R_HAS_STREAMS), &rt, arena, sizeof arena, &config);
    REFUSED("no arena", T3R_ERR_ARGUMENT, t3r_init, &rt, NULL, sizeof arena, &config);
    REFUSED("no place for the runtime", T3R_ERR_ARGUMENT, t3r_init, NULL, arena, sizeof arena, &config);
    REFUSED("an arena that is not aligned", T3R_ERR_ARENA, t3r_init, &rt, arena + 8, sizeof arena - 8, &config);
    REFUSED("an arena that is too small", T3R_ERR_ARENA, t3r_init, &rt, arena, 10000, &config);
    config.views = 17;
    REFUSED("too many views", T3R_ERR_CONFIG, t3r_init, &rt, arena, sizeof arena, &config);
}

TEST(copied_arenas)
{
    empty();
    build();
    static _Alignas(T3R_ARENA_ALIGN) uint8_t copy[sizeof arena];
    t3r_runtime *const copied = (t3r_runtime *)(void *)copy, *attached;
    memset(copy, 0, sizeof copy);
    REFUSED("bytes that are no arena", T3R_ERR_EPOCH, t3r_attach, &attached, copy, arena_bytes);
    REFUSED("an arena cut to a few bytes", T3R_ERR_ARENA, t3r_attach, &attached, copy, 100);
    memcpy(copy, arena, arena_bytes);
    REFUSED("an arena cut off", T3R_ERR_EPOCH, t3r_attach, &attached, copy, arena_bytes - 64);
    copied->bits_epoch--;
    REFUSED("an arena of an earlier epoch", T3R_ERR_EPOCH, t3r_attach, &attached, copy, arena_bytes);
    memcpy(copy, arena, arena_bytes);
    copied->config.width = 0;
    REFUSED("an arena with damaged settings", T3R_ERR_EPOCH, t3r_attach, &attached, copy, arena_bytes);
    memcpy(copy, arena, arena_bytes);
    copied->config.max_gaussians *= 1000;
    REFUSED("an arena with larger settings", T3R_ERR_EPOCH, t3r_attach, &attached, copy, arena_bytes);
    memcpy(copy, arena, arena_bytes);
    copied->gaussians = UINT32_MAX;
    REFUSED("an arena with damaged contents", T3R_ERR_EPOCH, t3r_attach, &attached, copy, arena_bytes);
}

TEST(what_is_bound)
{
    empty();
    REFUSED("no runtime", T3R_ERR_ARGUMENT, t3r_set_cpu, NULL, 0);
    REFUSED("a processor's feature without a name", T3R_ERR_ARGUMENT, t3r_set_cpu, rt, UINT32_C(1) << 30);
    static _Alignas(16) uint8_t weights[1 << 16];
    assert_true(t3r_head_tiny_bytes < sizeof weights);
    memcpy(weights, t3r_head_tiny, t3r_head_tiny_bytes);
    REFUSED("weights that are not aligned", T3R_ERR_ARGUMENT, t3r_bind_head, rt, weights + 4, t3r_head_tiny_bytes);
    REFUSED("weights cut off", T3R_ERR_WEIGHTS, t3r_bind_head, rt, weights, t3r_head_tiny_bytes - 16);
    weights[6]--;
    REFUSED("weights of an earlier epoch", T3R_ERR_WEIGHTS, t3r_bind_head, rt, weights, t3r_head_tiny_bytes);
    weights[6]++;
    weights[200]++;
    REFUSED("damaged weights", T3R_ERR_WEIGHTS, t3r_bind_head, rt, weights, t3r_head_tiny_bytes);
    WITH(head_column_bytes, 16);
    REFUSED("a head too large for the arena", T3R_ERR_WEIGHTS, t3r_bind_head, rt, t3r_head_tiny, t3r_head_tiny_bytes);
    WITH(views, 0);
    REFUSED("a head for an arena that only draws", T3R_ERR_STATE, t3r_bind_head, rt, t3r_head_tiny,
            t3r_head_tiny_bytes);
}

/* A frame with one damage is refused. */
#define BAD_FRAME(cause, status, ...)                                                                                  \
    do {                                                                                                               \
        empty();                                                                                                       \
        __VA_ARGS__;                                                                                                   \
        REFUSED(cause, status, t3r_add_view, rt, &frame, &camera);                                                     \
    } while (0)

TEST(frames)
{
    empty();
    REFUSED("no frame", T3R_ERR_ARGUMENT, t3r_add_view, rt, NULL, &camera);
    BAD_FRAME("a pixel format that is not there", T3R_ERR_FRAME, frame.format = T3R_PIXEL_FORMAT_COUNT);
    BAD_FRAME("a frame of width 0", T3R_ERR_FRAME, frame.width = 0);
    BAD_FRAME("a frame that is too high", T3R_ERR_FRAME, frame.height = 5000);
    BAD_FRAME("an odd width of YUYV", T3R_ERR_FRAME, frame.format = T3R_PIXEL_YUYV, frame.width = SIDE - 1);
    BAD_FRAME("an odd height of NV12", T3R_ERR_FRAME, frame.format = T3R_PIXEL_NV12, frame.height = SIDE - 1);
    BAD_FRAME("no colour", T3R_ERR_FRAME, frame.planes[0] = NULL);
    BAD_FRAME("a stride in pixels", T3R_ERR_FRAME, frame.stride_bytes[0] = SIDE);
    BAD_FRAME("a stride far too long", T3R_ERR_FRAME, frame.stride_bytes[0] = UINT32_MAX);
    BAD_FRAME("no second plane of NV12", T3R_ERR_FRAME, frame.format = T3R_PIXEL_NV12);
    BAD_FRAME("a short stride of NV12's second plane", T3R_ERR_FRAME, frame.format = T3R_PIXEL_NV12,
              frame.planes[1] = rgb);
    BAD_FRAME("no depth", T3R_ERR_NO_DEPTH, frame.depth = NULL);
    BAD_FRAME("a depth image without a size", T3R_ERR_FRAME, frame.depth_width = 0);
    BAD_FRAME("a depth image of height 1", T3R_ERR_FRAME, frame.depth_height = 1);
    BAD_FRAME("a depth stride in pixels", T3R_ERR_FRAME, frame.depth_stride_bytes = SIDE);
    BAD_FRAME("depth_unit_q40 forgotten", T3R_ERR_FRAME, frame.depth_unit_q40 = 0);
    BAD_FRAME("depth_unit_q40 far too long", T3R_ERR_FRAME, frame.depth_unit_q40 = UINT64_MAX);
    BAD_FRAME("a depth image without a measurement", T3R_ERR_NO_DEPTH, memset(depth, 0, sizeof depth));
}

TEST(cameras)
{
    empty();
    REFUSED("no camera", T3R_ERR_ARGUMENT, t3r_add_view, rt, &frame, NULL);
    BAD_FRAME("a camera of another size", T3R_ERR_CAMERA, camera.width = 640, camera.height = 480);
    BAD_FRAME("a focal length in pixels", T3R_ERR_CAMERA, camera.fx_q16 = 32);
    BAD_FRAME("a negative focal length", T3R_ERR_CAMERA, camera.fy_q16 = -camera.fy_q16);
    BAD_FRAME("a principal point far outside", T3R_ERR_CAMERA, camera.cx_q16 = INT32_MAX);
    BAD_FRAME("another principal point far outside", T3R_ERR_CAMERA, camera.cy_q16 = INT32_MIN);
    BAD_FRAME("a lens that is not there", T3R_ERR_CAMERA, camera.distortion = T3R_DISTORTION_COUNT);
    BAD_FRAME("no rotation", T3R_ERR_CAMERA, camera.rotation_q30[0] = 0);
    BAD_FRAME("a position out of range", T3R_ERR_CAMERA, camera.position_q32[1] = INT64_MIN);
    BAD_FRAME("a tangential coefficient of 100", T3R_ERR_CAMERA, camera.distortion = T3R_DISTORTION_RADTAN,
              camera.distortion_q24[2] = 100 << 24);
    BAD_FRAME("a lens that shows too little", T3R_ERR_CAMERA, camera.distortion = T3R_DISTORTION_RADTAN,
              camera.distortion_q24[0] = -(100 << 24));
    BAD_FRAME("a focal length out of range after resizing", T3R_ERR_CAMERA, frame.width = frame.height = 2,
              camera.fx_q16 = 16000 << 16);
}

TEST(views_out_of_order)
{
    empty();
    add(2);
    REFUSED("one view more than config.views", T3R_ERR_STATE, t3r_add_view, rt, &frame, &camera);
    empty();
    build();
    REFUSED("a view after the scene", T3R_ERR_STATE, t3r_add_view, rt, &frame, &camera);
    WITH(views, 0);
    REFUSED("a view for an arena that only draws", T3R_ERR_STATE, t3r_add_view, rt, &frame, &camera);
    WITH(stream, 1);
    REFUSED("a view for a stream", T3R_ERR_STATE, t3r_add_view, rt, &frame, &camera);
}

TEST(strips)
{
    empty();
    REFUSED("rows past the end", T3R_ERR_FRAME, t3r_add_rows, rt, &frame, &camera, 24, 16, 24, 8);
    frame.format = T3R_PIXEL_NV12;
    frame.planes[1] = rgb;
    frame.stride_bytes[1] = SIDE;
    REFUSED("an odd number of rows of NV12", T3R_ERR_FRAME, t3r_add_rows, rt, &frame, &camera, 0, 7, 0, 7);
    good_arguments();
    REFUSED("rows of depth past the end", T3R_ERR_FRAME, t3r_add_rows, rt, &frame, &camera, 24, 8, 24, 16);
    REFUSED("the second strip first", T3R_ERR_STATE, t3r_add_rows, rt, &frame, &camera, 8, 8, 8, 8);
    assert_int_equal(t3r_add_rows(rt, &frame, &camera, 0, 8, 0, 8), T3R_OK);
    REFUSED("a strip of depth twice", T3R_ERR_STATE, t3r_add_rows, rt, &frame, &camera, 8, 8, 0, 8);
    camera.cx_q16++;
    REFUSED("another camera for the second strip", T3R_ERR_STATE, t3r_add_rows, rt, &frame, &camera, 8, 8, 8, 8);
    empty();
    memset(depth, 0, sizeof depth);
    assert_int_equal(t3r_add_rows(rt, &frame, &camera, 0, 8, 0, 8), T3R_OK);
    REFUSED_TOO("no measurement", T3R_ERR_NO_DEPTH, t3r_add_rows, rt, &frame, &camera, 8, 24, 8, 24);
    WITH(warm, 1);
    add(2);
    REFUSED("a strip that would replace a view", T3R_ERR_STATE, t3r_add_rows, rt, &frame, &camera, 0, 8, 0, 8);
}

TEST(developing)
{
    empty();
    REFUSED("no place for the picture", T3R_ERR_ARGUMENT, t3r_develop, rt, &frame, &camera, NULL, NULL, &undistorted);
    REFUSED("no place for its camera", T3R_ERR_ARGUMENT, t3r_develop, rt, &frame, &camera, picture, NULL, NULL);
    add(1);
    REFUSED("the image stage alone, after a view", T3R_ERR_STATE, t3r_develop, rt, &frame, &camera, picture, NULL,
            &undistorted);
    WITH(views, 0);
    REFUSED("the image stage in an arena that only draws", T3R_ERR_STATE, t3r_develop, rt, &frame, &camera, picture,
            NULL, &undistorted);
}

TEST(builds_out_of_order)
{
    empty();
    REFUSED("no place for the scene", T3R_ERR_ARGUMENT, t3r_reconstruct, rt, NULL, NULL);
    REFUSED("a build without a view", T3R_ERR_STATE, t3r_reconstruct, rt, NULL, &scene);
    REFUSED("a rebuild without keep_analysis", T3R_ERR_STATE, t3r_rebuild, rt, NULL, &scene);
    build();
    assert_int_equal(t3r_render(rt, &camera, &target), T3R_OK);
    REFUSED("a build after t3r_render()", T3R_ERR_STATE, t3r_reconstruct, rt, NULL, &scene);
    WITH(keep_analysis, 1);
    add(1);
    REFUSED("a rebuild before the first build", T3R_ERR_STATE, t3r_rebuild, rt, NULL, &scene);
    WITH(head, T3R_HEAD_LEARNED);
    add(1);
    REFUSED("a build without the head's weights", T3R_ERR_STATE, t3r_reconstruct, rt, NULL, &scene);
    WITH(depth, T3R_DEPTH_STEREO);
    add(1);
    REFUSED("one view by stereo", T3R_ERR_STATE, t3r_reconstruct, rt, NULL, &scene);
    add(1);
    REFUSED("two views from one place by stereo", T3R_ERR_STEREO, t3r_reconstruct, rt, NULL, &scene);
    WITH(views, 0);
    REFUSED("a build in an arena that only draws", T3R_ERR_STATE, t3r_reconstruct, rt, NULL, &scene);
    WITH(stream, 1);
    REFUSED("a build of a stream", T3R_ERR_STATE, t3r_reconstruct, rt, NULL, &scene);
    empty();
    add(1);
    camera.position_q32[0] = INT64_C(1) << 50;
    add(1);
    REFUSED("two views a world apart", T3R_ERR_CAMERA, t3r_reconstruct, rt, NULL, &scene);
}

/* A request with one damage is refused. */
#define BAD_REQUEST(cause, status, ...)                                                                                \
    do {                                                                                                               \
        empty();                                                                                                       \
        add(1);                                                                                                        \
        __VA_ARGS__;                                                                                                   \
        REFUSED(cause, status, t3r_reconstruct, rt, &request, &scene);                                                 \
    } while (0)

TEST(requests)
{
    BAD_REQUEST("a request for too many Gaussians", T3R_ERR_ARGUMENT, request.gaussians = BUDGET + 1);
    BAD_REQUEST("an allocation that is not there", T3R_ERR_ARGUMENT, request.allocate = T3R_ALLOCATE_COUNT);
    BAD_REQUEST("a request for a head that is not there", T3R_ERR_ARGUMENT, request.head = T3R_HEAD_COUNT);
    BAD_REQUEST("a loss of 11 dB", T3R_ERR_ARGUMENT, request.max_loss_q8 = 11 * 256);
    BAD_REQUEST("a loss without keep_analysis", T3R_ERR_STATE, request.max_loss_q8 = 256);
    BAD_REQUEST("an importance that is missing", T3R_ERR_STATE, request.allocate = T3R_ALLOCATE_GIVEN);
    BAD_REQUEST("an importance with another allocation", T3R_ERR_ARGUMENT, request.allocate = T3R_ALLOCATE_RANDOM,
                request.importance = planes);
    BAD_REQUEST("a stride of importance in pixels", T3R_ERR_ARGUMENT, request.importance = planes,
                request.importance_stride_bytes = SIDE);
    const uint16_t *missing[] = {NULL}, *odd[] = {(const uint16_t *)(const void *)((const uint8_t *)plane + 1)};
    BAD_REQUEST("a view without importance", T3R_ERR_ARGUMENT, request.importance = missing,
                request.importance_stride_bytes = 2 * SIDE);
    BAD_REQUEST("an importance that is not aligned", T3R_ERR_ARGUMENT, request.importance = odd,
                request.importance_stride_bytes = 2 * SIDE);
}

TEST(least_budgets)
{
    t3r_least found;
    WITH(keep_analysis, 1);
    add(1);
    REFUSED("no picture for a PSNR", T3R_ERR_ARGUMENT, t3r_rebuild_least, rt, NULL, 256, NULL, &scene, &found);
    REFUSED("no place for what is found", T3R_ERR_ARGUMENT, t3r_rebuild_least, rt, NULL, 256, &target, &scene, NULL);
    REFUSED("a PSNR of 200 dB", T3R_ERR_ARGUMENT, t3r_rebuild_least, rt, NULL, 200 * 256, &target, &scene, &found);
    request.max_loss_q8 = 256;
    REFUSED("a PSNR with a loss", T3R_ERR_ARGUMENT, t3r_rebuild_least, rt, &request, 256, &target, &scene, &found);
    target.rgb = NULL;
    REFUSED("no memory for a view", T3R_ERR_ARGUMENT, t3r_rebuild_least, rt, NULL, 256, &target, &scene, &found);
    good_arguments();
    target.width = SIDE / 2;
    REFUSED("a picture of another size", T3R_ERR_ARGUMENT, t3r_rebuild_least, rt, NULL, 256, &target, &scene, &found);
}

TEST(streams)
{
    empty();
    REFUSED("a keyframe for a runtime of views", T3R_ERR_STATE, t3r_stream_keyframe, rt, &frame, &camera, &report);
    good_config();
    config.stream = 1;
    config.allocate = T3R_ALLOCATE_GIVEN;
    open_runtime();
    REFUSED("a keyframe by importance", T3R_ERR_STATE, t3r_stream_keyframe, rt, &frame, &camera, &report);
    WITH(stream, 1);
    REFUSED("a keyframe shown again before the first", T3R_ERR_STATE, t3r_stream_again, rt, &frame, &camera, 1);
    REFUSED("a round 0", T3R_ERR_ARGUMENT, t3r_stream_again, rt, &frame, &camera, 0);
    REFUSED("an overlap before the first keyframe", T3R_ERR_STATE, t3r_stream_overlap, rt, &camera, SIDE, SIDE,
            &overlap_q8);
    REFUSED("an overlap of a picture of width 0", T3R_ERR_ARGUMENT, t3r_stream_overlap, rt, &camera, 0, SIDE,
            &overlap_q8);
    REFUSED("an overlap of a picture of height 1", T3R_ERR_ARGUMENT, t3r_stream_overlap, rt, &camera, SIDE, 1,
            &overlap_q8);
    REFUSED("no place for the overlap", T3R_ERR_ARGUMENT, t3r_stream_overlap, rt, &camera, SIDE, SIDE, NULL);
    REFUSED("a map before the first keyframe", T3R_ERR_STATE, t3r_get_scene, rt, &scene);
    REFUSED("a Gaussian for a stream", T3R_ERR_STATE, t3r_scene_append, rt, &gaussian);
    good_config();
    config.stream = 1;
    config.gate = 0;
    open_runtime();
    assert_int_equal(t3r_stream_keyframe(rt, &frame, &camera, NULL), T3R_OK);
    frame.depth = NULL;
    REFUSED("a keyframe without depth", T3R_ERR_NO_DEPTH, t3r_stream_keyframe, rt, &frame, &camera, &report);
    camera.cx_q16 = 16383 << 16;
    REFUSED("an overlap by a principal point out of range after resizing", T3R_ERR_CAMERA, t3r_stream_overlap, rt,
            &camera, 2, 2, &overlap_q8);
    good_arguments();
    camera.position_q32[2] = INT64_C(1) << 50;
    REFUSED("a keyframe far from the map", T3R_ERR_CAMERA, t3r_stream_keyframe, rt, &frame, &camera, &report);
}

TEST(scenes)
{
    empty();
    REFUSED("a scene before the build", T3R_ERR_STATE, t3r_render, rt, &camera, &target);
    REFUSED("no Gaussian", T3R_ERR_ARGUMENT, t3r_scene_append, rt, NULL);
    REFUSED("a Gaussian before t3r_scene_begin()", T3R_ERR_STATE, t3r_scene_append, rt, &gaussian);
    REFUSED("the camera of a view that is not there", T3R_ERR_ARGUMENT, t3r_view_camera, rt, 2, &camera);
    uint16_t gain_q14[3];
    REFUSED("the gain of a view that is not there", T3R_ERR_ARGUMENT, t3r_view_gain, rt, 5, gain_q14);
    add(1);
    REFUSED("a view before the build", T3R_ERR_STATE, t3r_render, rt, &camera, &target);
    scene_frame.origin_q32[0] = INT64_MIN;
    REFUSED("an origin out of range", T3R_ERR_ARGUMENT, t3r_scene_begin, rt, &scene_frame);
    scene_frame = (t3r_scene_frame){.exponent = 25};
    REFUSED("an exponent out of range", T3R_ERR_ARGUMENT, t3r_scene_begin, rt, &scene_frame);
    scene_frame.exponent = 0;
    assert_int_equal(t3r_scene_begin(rt, &scene_frame), T3R_OK);
    gaussian.position_q20[2] = INT32_MAX;
    REFUSED("a Gaussian out of range", T3R_ERR_ARGUMENT, t3r_scene_append, rt, &gaussian);
    good_arguments();
    gaussian.colour_q7[1] = 40000;
    REFUSED("a colour out of range", T3R_ERR_ARGUMENT, t3r_scene_append, rt, &gaussian);
    good_arguments();
    gaussian.factor_exponent = 100;
    REFUSED("a factor out of range", T3R_ERR_ARGUMENT, t3r_scene_append, rt, &gaussian);
    good_arguments();
    gaussian.opacity_q15 = 40000;
    REFUSED("an opacity out of range", T3R_ERR_ARGUMENT, t3r_scene_append, rt, &gaussian);
    good_arguments();
    gaussian.reserved[0] = 1;
    REFUSED("a reserved byte that is set", T3R_ERR_ARGUMENT, t3r_scene_append, rt, &gaussian);
    good_arguments();
    for (uint32_t i = 0; i < BUDGET; i++) {
        assert_int_equal(t3r_scene_append(rt, &gaussian), T3R_OK);
    }
    REFUSED("a Gaussian more than max_gaussians", T3R_ERR_FULL, t3r_scene_append, rt, &gaussian);
}

/* A target or its camera with one damage is refused. */
#define BAD_TARGET(cause, status, ...)                                                                                 \
    do {                                                                                                               \
        good_arguments();                                                                                              \
        __VA_ARGS__;                                                                                                   \
        REFUSED(cause, status, t3r_render, rt, &camera, &target);                                                      \
    } while (0)

TEST(targets)
{
    empty();
    build();
    REFUSED("no target", T3R_ERR_ARGUMENT, t3r_render, rt, &camera, NULL);
    BAD_TARGET("a target too wide", T3R_ERR_ARGUMENT, target.width = 640);
    BAD_TARGET("a target too high", T3R_ERR_ARGUMENT, target.height = 480);
    BAD_TARGET("a target's stride in pixels", T3R_ERR_ARGUMENT, target.rgb_stride_bytes = SIDE);
    BAD_TARGET("a depth picture's stride in pixels", T3R_ERR_ARGUMENT, target.depth_stride_bytes = SIDE);
    BAD_TARGET("an alpha picture's stride in pixels", T3R_ERR_ARGUMENT, target.alpha_stride_bytes = SIDE);
    BAD_TARGET("a depth picture that is not aligned", T3R_ERR_ARGUMENT,
               target.depth_q20 = (uint32_t *)(void *)((uint8_t *)picture_depth + 2));
    BAD_TARGET("an alpha picture that is not aligned", T3R_ERR_ARGUMENT,
               target.alpha_q15 = (uint16_t *)(void *)((uint8_t *)picture_alpha + 1));
    BAD_TARGET("a view through a lens that distorts", T3R_ERR_CAMERA, camera.distortion = T3R_DISTORTION_FISHEYE);
    BAD_TARGET("a view from far away", T3R_ERR_CAMERA, camera.position_q32[0] = INT64_C(1) << 50);
}

TEST(rows_of_pixels)
{
    good_arguments();
    REFUSED("a packing that is not there", T3R_ERR_ARGUMENT, t3r_unpack_row, T3R_PACKING_COUNT, depth, SIDE, rgb);
    REFUSED("no row to unpack", T3R_ERR_ARGUMENT, t3r_unpack_row, T3R_PACKED_RGB565, NULL, SIDE, rgb);
    REFUSED("a row of no pixels", T3R_ERR_ARGUMENT, t3r_pack_row, T3R_PACKED_RGB565, picture, NULL, 0, depth);
    REFUSED("a Bayer order that is not there", T3R_ERR_ARGUMENT, t3r_demosaic_row, T3R_BAYER_COUNT, 0, depth, depth,
            depth, SIDE, rgb);
    REFUSED("no row above the first", T3R_ERR_ARGUMENT, t3r_demosaic_row, T3R_BAYER_RGGB, 0, NULL, depth, depth, SIDE,
            rgb);
    REFUSED("no place for the colours", T3R_ERR_ARGUMENT, t3r_demosaic_row, T3R_BAYER_RGGB, 0, depth, depth, depth,
            SIDE, NULL);
    REFUSED("a Bayer pattern of one column", T3R_ERR_ARGUMENT, t3r_demosaic_row, T3R_BAYER_RGGB, 0, depth, depth, depth,
            1, rgb);
    REFUSED("no view over a background", T3R_ERR_ARGUMENT, t3r_composite_row, NULL, picture_alpha, SIDE, rgb);
    REFUSED("a view over a background without its alpha", T3R_ERR_ARGUMENT, t3r_composite_row, picture, NULL, SIDE,
            rgb);
    REFUSED("no background", T3R_ERR_ARGUMENT, t3r_composite_row, picture, picture_alpha, SIDE, NULL);
}

/* Makes a lens that shows hardly anything. */
static void fold_lens(void)
{
    camera.distortion = T3R_DISTORTION_RADTAN;
    camera.distortion_q24[0] = -(100 << 24);
}

TEST(lenses_that_show_too_little)
{
    empty();
    fold_lens();
    REFUSED_TOO("more than half", T3R_ERR_CAMERA, t3r_add_rows, rt, &frame, &camera, 0, 8, 0, 8);
    REFUSED_TOO("more than half", T3R_ERR_CAMERA, t3r_develop, rt, &frame, &camera, picture, NULL, &undistorted);
    WITH(stream, 1);
    fold_lens();
    REFUSED_TOO("more than half", T3R_ERR_CAMERA, t3r_stream_keyframe, rt, &frame, &camera, &report);
    good_arguments();
    assert_int_equal(t3r_stream_keyframe(rt, &frame, &camera, NULL), T3R_OK);
    fold_lens();
    REFUSED_TOO("more than half", T3R_ERR_CAMERA, t3r_stream_keyframe, rt, &frame, &camera, &report);
}

TEST(strips_like_views)
{
    empty();
    REFUSED_TOO("rt is NULL", T3R_ERR_ARGUMENT, t3r_add_rows, NULL, &frame, &camera, 0, 8, 0, 8);
    frame.depth = NULL;
    REFUSED_TOO("frame.depth is NULL", T3R_ERR_NO_DEPTH, t3r_add_rows, rt, &frame, &camera, 0, 8, 0, 8);
    good_arguments();
    frame.width = 0;
    REFUSED_TOO("frame.width is 0", T3R_ERR_FRAME, t3r_add_rows, rt, &frame, &camera, 0, 8, 0, 8);
    good_arguments();
    add(2);
    REFUSED_TOO("the most by config.views", T3R_ERR_STATE, t3r_add_rows, rt, &frame, &camera, 0, 8, 0, 8);
}

/* t3r_rebuild_least() has the errors of the rebuilds and of the pictures that it makes. */
TEST(least_budgets_like_rebuilds)
{
    t3r_least found;
    WITH(keep_analysis, 1);
    add(1);
    REFUSED_TOO("there is no analysis", T3R_ERR_STATE, t3r_rebuild_least, rt, NULL, 256, &target, &scene, &found);
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    request.head = T3R_HEAD_COUNT;
    REFUSED_TOO("request.head", T3R_ERR_ARGUMENT, t3r_rebuild_least, rt, &request, 256, &target, &scene, &found);
    target.rgb_stride_bytes = SIDE;
    REFUSED_TOO("rgb_stride_bytes", T3R_ERR_ARGUMENT, t3r_rebuild_least, rt, NULL, 256, &target, &scene, &found);
}

TEST(streams_like_views)
{
    good_config();
    config.stream = 1;
    config.gate = 0;
    open_runtime();
    assert_int_equal(t3r_stream_keyframe(rt, &frame, &camera, NULL), T3R_OK);
    memset(depth, 0, sizeof depth);
    REFUSED_TOO("no measurement", T3R_ERR_NO_DEPTH, t3r_stream_keyframe, rt, &frame, &camera, &report);
    camera.position_q32[2] = INT64_C(1) << 50;
    REFUSED_TOO("more than 1,024", T3R_ERR_CAMERA, t3r_stream_overlap, rt, &camera, SIDE, SIDE, &overlap_q8);
}

TEST(missing_arguments)
{
    t3r_least found;
    empty();
    REFUSED_TOO("rt is NULL", T3R_ERR_ARGUMENT, t3r_bind_head, NULL, t3r_head_tiny, t3r_head_tiny_bytes);
    REFUSED_TOO("rt is NULL", T3R_ERR_ARGUMENT, t3r_develop, NULL, &frame, &camera, picture, NULL, &undistorted);
    REFUSED_TOO("rt is NULL", T3R_ERR_ARGUMENT, t3r_get_scene, NULL, &scene);
    REFUSED_TOO("rt is NULL", T3R_ERR_ARGUMENT, t3r_render, NULL, &camera, &target);
    REFUSED_TOO("rt is NULL", T3R_ERR_ARGUMENT, t3r_scene_begin, NULL, &scene_frame);
    REFUSED_TOO("rt is NULL", T3R_ERR_ARGUMENT, t3r_scene_append, NULL, &gaussian);
    REFUSED_TOO("scene is NULL", T3R_ERR_ARGUMENT, t3r_get_scene, rt, NULL);
    REFUSED_TOO("scene is NULL", T3R_ERR_ARGUMENT, t3r_rebuild_least, rt, NULL, 256, &target, NULL, &found);
    REFUSED_TOO("frame is NULL", T3R_ERR_ARGUMENT, t3r_scene_begin, rt, NULL);
    REFUSED_TOO("camera is NULL", T3R_ERR_ARGUMENT, t3r_render, rt, NULL, &target);
    REFUSED_TOO("camera is NULL", T3R_ERR_ARGUMENT, t3r_view_camera, rt, 0, NULL);
    REFUSED_TOO("gain_q14 is NULL", T3R_ERR_ARGUMENT, t3r_view_gain, rt, 0, NULL);
    REFUSED_TOO("camera is NULL", T3R_ERR_ARGUMENT, t3r_stream_overlap, rt, NULL, SIDE, SIDE, &overlap_q8);
    REFUSED_TOO("no stream", T3R_ERR_STATE, t3r_stream_overlap, rt, &camera, SIDE, SIDE, &overlap_q8);
    REFUSED_TOO("config is NULL", T3R_ERR_ARGUMENT, t3r_init, &rt, arena, sizeof arena, NULL);
    REFUSED_TOO("config is NULL", T3R_ERR_ARGUMENT, t3r_plan_within, sizeof arena, NULL);
    REFUSED_TOO("arena is NULL", T3R_ERR_ARGUMENT, t3r_attach, &rt, NULL, sizeof arena);
    REFUSED_TOO("arena is 8 bytes", T3R_ERR_ARENA, t3r_attach, &rt, arena + 8, sizeof arena - 8);
}

/* Ranges from their other end. */
TEST(other_bounds)
{
    t3r_least found;
    good_config();
    assert_int_equal(t3r_plan_within(sizeof arena, &config), T3R_OK);
    config.gaussians = config.max_gaussians + 1;
    REFUSED_TOO("config.gaussians", T3R_ERR_CONFIG, t3r_plan_within, sizeof arena, &config);
    config.max_gaussians = T3R_MAX_GAUSSIANS + 1;
    REFUSED_TOO("config.max_gaussians", T3R_ERR_CONFIG, t3r_plan_within, sizeof arena, &config);
    good_config();
    config.width = 4;
    REFUSED_TOO("width must be", T3R_ERR_CONFIG, t3r_plan_within, sizeof arena, &config);
    WITH(keep_analysis, 1);
    build();
    target.width = 0;
    REFUSED_TOO("target.width", T3R_ERR_ARGUMENT, t3r_render, rt, &camera, &target);
    good_arguments();
    target.height = 0;
    REFUSED_TOO("target.height", T3R_ERR_ARGUMENT, t3r_render, rt, &camera, &target);
    REFUSED_TOO("working size", T3R_ERR_ARGUMENT, t3r_rebuild_least, rt, NULL, 256, &target, &scene, &found);
    good_arguments();
    target.alpha_stride_bytes++;
    REFUSED_TOO("alpha_stride_bytes", T3R_ERR_ARGUMENT, t3r_render, rt, &camera, &target);
    good_arguments();
    camera.fx_q16 = 0;
    REFUSED_TOO("camera.fx_q16", T3R_ERR_CAMERA, t3r_render, rt, &camera, &target);
    gaussian.factor_exponent = -61;
    REFUSED_TOO("factor_exponent", T3R_ERR_ARGUMENT, t3r_scene_append, rt, &gaussian);
    request.importance = planes;
    request.importance_stride_bytes = 2 * SIDE + 1;
    REFUSED_TOO("importance_stride_bytes", T3R_ERR_ARGUMENT, t3r_rebuild, rt, &request, &scene);
    WITH(stream, 1);
    REFUSED_TOO("a stream's", T3R_ERR_STATE, t3r_scene_begin, rt, &scene_frame);
    good_config();
    config.stream = 1;
    config.head = T3R_HEAD_LEARNED;
    open_runtime();
    REFUSED_TOO("no head is bound", T3R_ERR_STATE, t3r_stream_keyframe, rt, &frame, &camera, &report);
}

#define SWITCH(FEATURE, name) "T3R_FEATURE_" #FEATURE "=1",
#define COUNT(array) (sizeof(array) / sizeof *(array))

/* Another header, and each other feature, is named by each call that takes the program's digest. */
TEST(another_interface)
{
    static const char *const switches[] = {T3R_FEATURE_ROWS(SWITCH)};
    t3r_plan_info plan;
    size_t least, bytes;
    empty();
    for (size_t i = 0; i <= COUNT(switches); i++) {
        const uint64_t other = t3r_header_interface() ^ (uint64_t)1 << i;
        const char *words = i < COUNT(switches) ? switches[i] : "another trim3r.h";
        REFUSED_TOO(words, T3R_ERR_INTERFACE, t3r_plan_as, other, &config, &plan);
        REFUSED_TOO(words, T3R_ERR_INTERFACE, t3r_plan_bytes_as, other, &config, &least, &bytes);
        REFUSED_TOO(words, T3R_ERR_INTERFACE, t3r_plan_within_as, other, sizeof arena, &config);
        REFUSED_TOO(words, T3R_ERR_INTERFACE, t3r_set_preset_as, other, T3R_PRESET_FAST, &config, NULL);
        REFUSED_TOO(words, T3R_ERR_INTERFACE, t3r_init_as, other, &rt, arena, sizeof arena, &config);
        REFUSED_TOO(words, T3R_ERR_INTERFACE, t3r_attach_as, other, &rt, arena, arena_bytes);
    }
    char text[T3R_ERROR_BYTES];
    const uint64_t without = t3r_header_interface() ^ t3r_features(); /* the library has all */
    (void)t3r_plan_as_error(t3r_plan_as(without, &config, &plan), without, &config, &plan, text, sizeof text);
    for (size_t i = 0; i < COUNT(switches); i++) {
        assert_non_null(strstr(text, switches[i]));
    }
    assert_true(strlen(text) + 1 < sizeof text);
}

/* An error that no check explains, a status that the call did not return, and no error. */
TEST(other_errors)
{
    empty();
    add(1);
    char text[T3R_ERROR_BYTES];
    static const t3r_status others[] = {T3R_OK, T3R_ERR_CANCELLED, T3R_ERR_FULL, T3R_ERR_CAMERA, -1000};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        assert_string_equal(t3r_reconstruct_error(others[i], rt, NULL, &scene, text, sizeof text),
                            t3r_error_text(others[i]));
        assert_string_equal(t3r_render_error(others[i], rt, &camera, &target, text, sizeof text),
                            t3r_error_text(others[i]));
        assert_string_equal(t3r_attach_error(others[i], &rt, arena, arena_bytes, text, sizeof text),
                            t3r_error_text(others[i]));
        assert_string_equal(t3r_add_view_error(others[i], NULL, &frame, &camera, text, sizeof text),
                            t3r_error_text(others[i]));
    }
}

/* ---- the table of docs/errors.md ------------------------------------------------------------------------------------
 */

TEST(table)
{
    const char *path = getenv("T3R_TABLE");
    if (path == NULL) {
        return;
    }
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "| cause | call | `t3r_error_text()` | `t3r_..._error()` |\n|---|---|---|---|\n");
    for (size_t i = 0; i < row_count; i++) {
        const char *as = strstr(rows[i].call, "_as"); /* the inline call is the one that programs make */
        const int length = (int)(as != NULL ? (size_t)(as - rows[i].call) : strlen(rows[i].call));
        fprintf(file, "| %s | `%.*s()` | %s | %s |\n", rows[i].cause, length, rows[i].call,
                t3r_error_text(rows[i].status), rows[i].sentence);
    }
    assert_int_equal(fclose(file), 0);
}
