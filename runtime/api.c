/* The C interface: what it is given is checked here (a render's in raster.c, a frame's content in the image stage), and
 * nowhere deeper. */
#include <string.h>

#include "core/arena.h"
#include "budget/budget_choice.h"
#include "core/camera.h"
#include "image/develop.h"
#include "core/hash.h"
#include "head/head.h"
#include "image/image.h"
#include "pipeline.h"
#include "core/scene_frame.h"
#include "core/state.h"
#include "stream/stream.h"
#include "stream/stream_overlap.h"
#include "superclusters/superclusters.h"
#include "head/weights.h"

/* --- the arena ---------------------------------------------------------------------------------------------------- */

static bool is_frame(const t3r_scene_frame *frame)
{
    const int64_t most = (int64_t)1 << 62;
    for (int i = 0; i < 3; i++) {
        if (frame->origin_q32[i] <= -most || frame->origin_q32[i] >= most) {
            return false;
        }
    }
    return frame->exponent >= T3R_EXPONENT_LEAST && frame->exponent <= T3R_EXPONENT_MOST;
}

/* Changes with the layout: an arena laid out by another build is refused. */
static uint64_t layout_hash(const t3r_layout *layout)
{
    uint64_t hash = t3r_hash_u32(T3R_HASH_START, T3R_BUFFER_COUNT);
    for (int b = 0; b < T3R_BUFFER_COUNT; b++) {
        hash = t3r_hash_u64(t3r_hash_u64(hash, layout->offset[b]), layout->size[b]);
    }
    return t3r_hash_u32(hash, (uint32_t)sizeof(struct t3r_runtime));
}

static void bind_layout(t3r_runtime *rt, const t3r_layout *layout)
{
    for (int b = 0; b < T3R_BUFFER_COUNT; b++) {
        rt->offset[b] = layout->offset[b];
    }
    rt->list_capacity = layout->list_capacity;
    rt->refine_bytes = layout->refine_bytes;
    rt->layout_hash = layout_hash(layout);
}

t3r_status t3r_init(t3r_runtime **rt, void *arena, size_t arena_bytes, const t3r_config *config)
{
    T3R_REFUSE_UNLESS(rt != NULL, T3R_ERR_ARGUMENT);
    *rt = NULL;
    T3R_REFUSE_UNLESS(arena != NULL && config != NULL, T3R_ERR_ARGUMENT);
    if (t3r_config_error(config) != NULL) {
        return T3R_ERR_CONFIG;
    }
    t3r_layout layout;
    if ((uintptr_t)arena % T3R_ARENA_ALIGN != 0 || t3r_lay_out(config, arena_bytes, &layout) != T3R_OK) {
        return T3R_ERR_ARENA;
    }
    t3r_runtime *state = arena;
    memset(state, 0, sizeof *state);
    state->magic = T3R_MAGIC;
    state->bits_epoch = T3R_BITS_EPOCH;
    state->arena_bytes = arena_bytes;
    state->config = *config;
    state->kernels = t3r_kernels_c;
    bind_layout(state, &layout);
    *rt = state;
    return T3R_OK;
}

static bool is_sound(const t3r_gaussian *g)
{
    for (int i = 0; i < 3; i++) {
        if (g->position_q20[i] < -T3R_POSITION_MOST_Q20 || g->position_q20[i] > T3R_POSITION_MOST_Q20 ||
            g->colour_q7[i] > 255 * 128 || g->reserved[i] != 0) {
            return false;
        }
    }
    return g->factor_exponent >= -60 && g->factor_exponent <= 15 && g->opacity_q15 <= 32767;
}

/* Whether labels and SuperClusters of a copied analysis stay within what the budget stage counts on. */
static bool is_analysis(const t3r_runtime *rt)
{
    size_t points = T3R_PIXELS_(rt->config.width, rt->config.height) * rt->views;
    const uint16_t *labels = t3r_buffer_at(rt, T3R_BUFFER_LABELS);
    const t3r_cluster *clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS);
    for (size_t i = 0; i < points; i++) {
        if (labels[i] >= rt->config.clusters && labels[i] != T3R_NO_LABEL) {
            return false;
        }
    }
    for (uint32_t k = 0; k < rt->config.clusters; k++) {
        if (clusters[k].points > points || clusters[k].texture_q4 > UINT16_MAX ||
            clusters[k].order >= rt->config.clusters) {
            return false;
        }
    }
    return rt->median_depth_q20 >= 1 << 20 && rt->median_depth_q20 < 2 << 20 && rt->valid_points <= points;
}

static bool is_scene(const t3r_runtime *rt)
{
    const t3r_gaussian *scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    for (uint32_t i = 0; i < rt->gaussians; i++) {
        if (!is_sound(&scene[i])) {
            return false;
        }
    }
    return true;
}

/* Whether the slots of a stream's keyframes are those that taking them one after the other fills. */
static bool is_stream(const t3r_runtime *rt)
{
    bool full = rt->views == rt->config.views;
    return !rt->analysed && rt->next_slot <= rt->views && rt->next_slot < rt->config.views &&
           (full || rt->next_slot == rt->views) && rt->gaussians <= rt->config.gaussians &&
           (rt->has_scene ? rt->views > 0 && rt->keyframes >= rt->views
                          : rt->views == 0 && rt->keyframes == 0 && rt->gaussians == 0);
}

/* Whether a copied arena holds what the stages rely on. Planes may hold anything. */
static bool is_consistent(const t3r_runtime *rt)
{
    if (rt->views > rt->config.views || rt->gaussians > rt->config.max_gaussians || rt->analysed > 1 ||
        rt->has_scene > 1 || !is_frame(&rt->frame) || (rt->config.stream ? !is_stream(rt) : rt->next_slot != 0)) {
        return false;
    }
    for (uint32_t v = 0; v < rt->views; v++) {
        t3r_pose pose;
        if (rt->stereo_pair[v] >= T3R_PAIR_COUNT || rt->stereo_partner[v] >= T3R_MAX_VIEWS ||
            t3r_camera_check(&rt->camera[v]) != T3R_OK || rt->depth_unit_q40[v] == 0 ||
            rt->depth_unit_q40[v] > T3R_MAX_DEPTH_UNIT_Q40 ||
            (rt->analysed && t3r_pose_in_scene(&rt->camera[v], &rt->frame, &pose) != T3R_OK)) {
            return false;
        }
    }
    return (!rt->analysed || is_analysis(rt)) && (!rt->has_scene || is_scene(rt));
}

t3r_status t3r_attach(t3r_runtime **rt, void *arena, size_t arena_bytes)
{
    T3R_REFUSE_UNLESS(rt != NULL, T3R_ERR_ARGUMENT);
    *rt = NULL;
    T3R_REFUSE_UNLESS(arena != NULL, T3R_ERR_ARGUMENT);
    if ((uintptr_t)arena % T3R_ARENA_ALIGN != 0 || arena_bytes < T3R_HEADER_BYTES) {
        return T3R_ERR_ARENA;
    }
    t3r_runtime *state = arena;
    t3r_layout layout;
    if (state->magic != T3R_MAGIC || state->bits_epoch != T3R_BITS_EPOCH || state->arena_bytes != arena_bytes ||
        t3r_config_error(&state->config) != NULL || t3r_lay_out(&state->config, arena_bytes, &layout) != T3R_OK ||
        state->layout_hash != layout_hash(&layout)) {
        return T3R_ERR_EPOCH;
    }
    bind_layout(state, &layout);
    if (!is_consistent(state)) {
        return T3R_ERR_EPOCH;
    }
    memset(&state->hooks, 0, sizeof state->hooks);
    state->weights = NULL;
    state->kernels = t3r_kernels_c;
    *rt = state;
    return T3R_OK;
}

t3r_status t3r_set_hooks(t3r_runtime *rt, const t3r_hooks *hooks)
{
    T3R_REFUSE_UNLESS(rt != NULL, T3R_ERR_ARGUMENT);
    rt->hooks = hooks != NULL ? *hooks : (t3r_hooks){0};
    return T3R_OK;
}

t3r_status t3r_set_cpu(t3r_runtime *rt, uint32_t features)
{
    T3R_REFUSE_UNLESS(rt != NULL, T3R_ERR_ARGUMENT);
    t3r_kernels_choose(&rt->kernels, features);
    return T3R_OK;
}

t3r_status t3r_bind_head(t3r_runtime *rt, const void *weights, size_t bytes)
{
    T3R_REFUSE_UNLESS(rt != NULL, T3R_ERR_ARGUMENT);
    if (weights == NULL) {
        rt->weights = NULL;
        return T3R_OK;
    }
    T3R_REFUSE_UNLESS(rt->config.views > 0, T3R_ERR_STATE);
    t3r_status status = t3r_weights_check(weights, bytes);
    if (status != T3R_OK) {
        return status;
    }
    const t3r_config *c = &rt->config;
    if (t3r_head_learned_work_bytes(weights, c->width) > T3R_HEAD_WORK_(c->width, c->height, c->head_column_bytes)) {
        return T3R_ERR_WEIGHTS;
    }
    rt->weights = weights;
    rt->head_crc = t3r_weights_header_of(weights).crc;
    return T3R_OK;
}

uint32_t t3r_head_column_bytes(const void *weights, size_t bytes, uint32_t width)
{
    if (width == 0 || width > T3R_MAX_SIDE || t3r_weights_check(weights, bytes) != T3R_OK) {
        return 0;
    }
    const size_t columns = T3R_HEAD_COLUMNS_(width), work = t3r_head_learned_work_bytes(weights, width);
    size_t a_column = work <= T3R_HEAD_KERNEL_BYTES ? 1 : (work - T3R_HEAD_KERNEL_BYTES + columns - 1) / columns;
    return a_column > UINT32_MAX ? UINT32_MAX : (uint32_t)a_column;
}

uint32_t t3r_head_crc(const t3r_runtime *rt)
{
    return rt == NULL ? 0 : rt->head_crc;
}

/* Whether what the head needs is there. */
static bool has_head(const t3r_runtime *rt, t3r_head head)
{
    return head != T3R_HEAD_LEARNED || rt->weights != NULL;
}

t3r_status t3r_reset(t3r_runtime *rt)
{
    T3R_REFUSE_UNLESS(rt != NULL, T3R_ERR_ARGUMENT);
    rt->views = 0;
    rt->analysed = 0;
    rt->has_scene = 0;
    rt->gaussians = 0;
    rt->valid_points = 0;
    rt->keyframes = 0;
    rt->next_slot = 0;
    return T3R_OK;
}

/* --- views -------------------------------------------------------------------------------------------------------- */

static bool has_measured_depth(const t3r_runtime *rt, uint32_t index)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    size_t pixels = T3R_PIXELS_(rt->config.width, rt->config.height);
    for (size_t i = 0; i < pixels; i++) {
        if (t3r_is_reliable(views[index].validity[i])) {
            return true;
        }
    }
    return false;
}

t3r_status t3r_add_view(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera)
{
    T3R_REFUSE_UNLESS(rt != NULL && frame != NULL && camera != NULL, T3R_ERR_ARGUMENT);
    T3R_REFUSE_UNLESS(!rt->config.stream && rt->views < rt->config.views && !rt->has_scene, T3R_ERR_STATE);
    const bool stereo = rt->config.depth == T3R_DEPTH_STEREO;
    t3r_frame shown = *frame;
    if (stereo) {
        shown.depth = NULL;
    } else if (frame->depth == NULL) {
        return T3R_ERR_NO_DEPTH;
    }
    rt->analysed = 0; /* the image stage works where later planes are */
    t3r_camera undistorted;
    t3r_status status = t3r_develop_view(rt, rt->views, &shown, camera, &undistorted);
    if (status != T3R_OK) {
        return status;
    }
    if (!stereo && !has_measured_depth(rt, rt->views)) {
        return T3R_ERR_NO_DEPTH;
    }
    rt->camera[rt->views] = undistorted;
    rt->depth_unit_q40[rt->views] = stereo ? 1 : frame->depth_unit_q40; /* stereo chooses its own */
    rt->stereo_pair[rt->views] = T3R_PAIR_OK;
    rt->stereo_partner[rt->views] = (uint8_t)rt->views;
    rt->views++;
    return T3R_OK;
}

t3r_status t3r_develop(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint8_t *rgb_out,
                       uint16_t *depth_out, t3r_camera *undistorted)
{
    T3R_REFUSE_UNLESS(rt != NULL && frame != NULL && camera != NULL && rgb_out != NULL && undistorted != NULL,
                      T3R_ERR_ARGUMENT);
    T3R_REFUSE_UNLESS(rt->config.views > 0 && rt->views == 0 && !rt->has_scene, T3R_ERR_STATE);
    t3r_status status = t3r_develop_view(rt, 0, frame, camera, undistorted);
    if (status != T3R_OK) {
        return status;
    }
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    size_t pixels = T3R_PIXELS_(rt->config.width, rt->config.height);
    for (size_t i = 0; i < pixels; i++) {
        for (int c = 0; c < 3; c++) {
            rgb_out[3 * i + (size_t)c] = views[0].colour[c][i];
        }
    }
    if (depth_out != NULL) {
        memcpy(depth_out, views[0].depth, pixels * sizeof *depth_out);
    }
    return T3R_OK;
}

/* --- streams ------------------------------------------------------------------------------------------------------ */

t3r_status t3r_stream_keyframe(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                               t3r_stream_report *report)
{
    T3R_REFUSE_UNLESS(rt != NULL && frame != NULL && camera != NULL, T3R_ERR_ARGUMENT);
    T3R_REFUSE_UNLESS(rt->config.stream && has_head(rt, rt->config.head) && rt->config.allocation != T3R_ALLOCATE_GIVEN,
                      T3R_ERR_STATE);
    if (frame->depth == NULL) {
        return T3R_ERR_NO_DEPTH;
    }
    t3r_stream_report told = {0};
    t3r_status status = t3r_stream_follow(rt, frame, camera);
    if (status == T3R_OK) {
        status = t3r_stream_take(rt, frame, camera, &told);
    }
    if (report != NULL) {
        *report = told;
    }
    return status;
}

t3r_status t3r_stream_overlap(const t3r_runtime *rt, const t3r_camera *camera, uint32_t width, uint32_t height,
                              uint32_t *overlap_q8)
{
    T3R_REFUSE_UNLESS(rt != NULL && camera != NULL && overlap_q8 != NULL && width >= 2 && width <= T3R_MAX_SIDE &&
                          height >= 2 && height <= T3R_MAX_SIDE,
                      T3R_ERR_ARGUMENT);
    T3R_REFUSE_UNLESS(rt->config.stream && rt->keyframes > 0, T3R_ERR_STATE);
    t3r_status status = t3r_camera_check(camera);
    return status == T3R_OK ? t3r_overlap_with_newest(rt, camera, width, height, overlap_q8) : status;
}

/* --- scenes ------------------------------------------------------------------------------------------------------- */

t3r_status t3r_get_scene(const t3r_runtime *rt, t3r_scene *scene)
{
    T3R_REFUSE_UNLESS(rt != NULL && scene != NULL, T3R_ERR_ARGUMENT);
    if (!rt->has_scene) {
        return T3R_ERR_STATE;
    }
    scene->frame = rt->frame;
    scene->gaussians = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    scene->count = rt->gaussians;
    scene->valid_points = rt->valid_points;
    return T3R_OK;
}

/* Whether there is a readable plane for each view added. */
static bool is_importance(const t3r_runtime *rt, const t3r_importance *importance)
{
    if (importance->planes == NULL || importance->stride_bytes % 2 != 0 ||
        importance->stride_bytes / 2 < rt->config.width) {
        return false;
    }
    for (uint32_t v = 0; v < rt->views; v++) {
        const uint16_t *plane = importance->planes[v];
        if (plane == NULL || (uintptr_t)plane % _Alignof(uint16_t) != 0) {
            return false;
        }
    }
    return true;
}

/* Whether what settings need besides the views is there. */
static bool is_served(const t3r_runtime *rt, const t3r_config *config, const t3r_importance *importance)
{
    return has_head(rt, config->head) && (config->allocation == T3R_ALLOCATE_GIVEN) == (importance != NULL);
}

/* Budget and head by other settings; these stay only when there is a scene. */
static t3r_status build_by(t3r_runtime *rt, const t3r_config *config, const t3r_importance *importance,
                           t3r_scene *scene)
{
    t3r_config before = rt->config;
    rt->config = *config;
    t3r_status status = t3r_build_scene(rt, importance);
    if (status != T3R_OK) {
        rt->config = before;
        return status;
    }
    return t3r_get_scene(rt, scene);
}

/* Whether there are views to make a scene of at once. */
static bool has_views(const t3r_runtime *rt)
{
    return !rt->config.stream && rt->views >= (rt->config.depth == T3R_DEPTH_STEREO ? 2u : 1u);
}

static t3r_status reconstruct(t3r_runtime *rt, const t3r_config *config, const t3r_importance *importance,
                              t3r_scene *scene)
{
    T3R_REFUSE_UNLESS(has_views(rt) && is_served(rt, config, importance), T3R_ERR_STATE);
    rt->has_scene = 0;
    rt->analysed = 0;
    t3r_status status = t3r_analyse(rt);
    return status == T3R_OK ? build_by(rt, config, importance, scene) : status;
}

t3r_status t3r_reconstruct(t3r_runtime *rt, t3r_scene *scene)
{
    T3R_REFUSE_UNLESS(rt != NULL && scene != NULL, T3R_ERR_ARGUMENT);
    t3r_config config = rt->config;
    return reconstruct(rt, &config, NULL, scene);
}

t3r_status t3r_reconstruct_given(t3r_runtime *rt, const uint16_t *const importance[], uint32_t stride_bytes,
                                 t3r_scene *scene)
{
    const t3r_importance given = {importance, stride_bytes};
    T3R_REFUSE_UNLESS(rt != NULL && scene != NULL && is_importance(rt, &given), T3R_ERR_ARGUMENT);
    t3r_config config = rt->config;
    config.allocation = T3R_ALLOCATE_GIVEN;
    return reconstruct(rt, &config, &given, scene);
}

static bool is_loss(uint32_t max_loss_q8)
{
    return max_loss_q8 >= 1 && max_loss_q8 <= T3R_MAX_LOSS_Q8;
}

/* Whether trial scenes can be made and measured, one after the other, of one analysis. */
static bool is_tried(const t3r_config *config)
{
    return config->keep_analysis && config->refinements > 0;
}

/* The budget chosen on the analysed views, at most that of the settings; these stay only when there is a scene. */
static t3r_status build_within(t3r_runtime *rt, const t3r_config *config, uint32_t max_loss_q8, t3r_scene *scene)
{
    t3r_config before = rt->config, chosen = *config;
    rt->config = *config;
    t3r_status status = t3r_choose_budget(rt, max_loss_q8, &chosen.gaussians);
    rt->config = before;
    rt->has_scene = 0; /* the trial's */
    return status == T3R_OK ? build_by(rt, &chosen, NULL, scene) : status;
}

t3r_status t3r_reconstruct_within(t3r_runtime *rt, uint32_t max_loss_q8, t3r_scene *scene)
{
    T3R_REFUSE_UNLESS(rt != NULL && scene != NULL && is_loss(max_loss_q8), T3R_ERR_ARGUMENT);
    T3R_REFUSE_UNLESS(has_views(rt) && is_tried(&rt->config) && is_served(rt, &rt->config, NULL), T3R_ERR_STATE);
    rt->has_scene = 0;
    rt->analysed = 0;
    t3r_config config = rt->config;
    t3r_status status = t3r_analyse(rt);
    return status == T3R_OK ? build_within(rt, &config, max_loss_q8, scene) : status;
}

static t3r_status rebuild(t3r_runtime *rt, const t3r_config *config, const t3r_importance *importance, t3r_scene *scene)
{
    if (t3r_config_error(config) != NULL) {
        return T3R_ERR_ARGUMENT;
    }
    T3R_REFUSE_UNLESS(rt->config.keep_analysis && rt->analysed && is_served(rt, config, importance), T3R_ERR_STATE);
    return build_by(rt, config, importance, scene);
}

t3r_status t3r_reallocate(t3r_runtime *rt, uint32_t gaussians, t3r_allocation allocation, t3r_head head,
                          t3r_scene *scene)
{
    T3R_REFUSE_UNLESS(rt != NULL && scene != NULL, T3R_ERR_ARGUMENT);
    t3r_config config = rt->config;
    config.gaussians = gaussians;
    config.allocation = allocation;
    config.head = head;
    return rebuild(rt, &config, NULL, scene);
}

t3r_status t3r_rebudget(t3r_runtime *rt, uint32_t gaussians, t3r_scene *scene)
{
    T3R_REFUSE_UNLESS(rt != NULL, T3R_ERR_ARGUMENT);
    return t3r_reallocate(rt, gaussians, rt->config.allocation, rt->config.head, scene);
}

t3r_status t3r_rebudget_within(t3r_runtime *rt, uint32_t most, uint32_t max_loss_q8, t3r_scene *scene)
{
    T3R_REFUSE_UNLESS(rt != NULL && scene != NULL && is_loss(max_loss_q8), T3R_ERR_ARGUMENT);
    t3r_config config = rt->config;
    config.gaussians = most;
    if (t3r_config_error(&config) != NULL) {
        return T3R_ERR_ARGUMENT;
    }
    T3R_REFUSE_UNLESS(rt->analysed && is_tried(&config) && is_served(rt, &config, NULL), T3R_ERR_STATE);
    return build_within(rt, &config, max_loss_q8, scene);
}

t3r_status t3r_rebudget_given(t3r_runtime *rt, uint32_t gaussians, const uint16_t *const importance[],
                              uint32_t stride_bytes, t3r_scene *scene)
{
    const t3r_importance given = {importance, stride_bytes};
    T3R_REFUSE_UNLESS(rt != NULL && scene != NULL && is_importance(rt, &given), T3R_ERR_ARGUMENT);
    t3r_config config = rt->config;
    config.gaussians = gaussians;
    config.allocation = T3R_ALLOCATE_GIVEN;
    return rebuild(rt, &config, &given, scene);
}

t3r_status t3r_scene_begin(t3r_runtime *rt, const t3r_scene_frame *frame)
{
    T3R_REFUSE_UNLESS(rt != NULL && frame != NULL, T3R_ERR_ARGUMENT);
    if (!is_frame(frame)) {
        return T3R_ERR_ARGUMENT;
    }
    T3R_REFUSE_UNLESS(!rt->config.stream, T3R_ERR_STATE);
    (void)t3r_reset(rt);
    rt->frame = *frame;
    rt->has_scene = 1;
    return T3R_OK;
}

t3r_status t3r_scene_append(t3r_runtime *rt, const t3r_gaussian *gaussian)
{
    T3R_REFUSE_UNLESS(rt != NULL && gaussian != NULL, T3R_ERR_ARGUMENT);
    if (!is_sound(gaussian)) {
        return T3R_ERR_ARGUMENT;
    }
    T3R_REFUSE_UNLESS(rt->has_scene && !rt->config.stream, T3R_ERR_STATE);
    if (rt->gaussians >= rt->config.max_gaussians) {
        return T3R_ERR_FULL;
    }
    t3r_gaussian *scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    scene[rt->gaussians++] = *gaussian;
    return T3R_OK;
}

t3r_pair t3r_stereo_pair(const t3r_runtime *rt, uint32_t view, uint32_t *partner)
{
    const bool known = rt != NULL && rt->config.depth == T3R_DEPTH_STEREO && view < rt->views;
    if (partner != NULL) {
        *partner = known ? rt->stereo_partner[view] : view;
    }
    return known ? (t3r_pair)rt->stereo_pair[view] : T3R_PAIR_OK;
}

uint32_t t3r_render_passes(const t3r_runtime *rt)
{
    return rt == NULL ? 0 : rt->render_passes;
}
