#include "pipeline.h"

#include "budget.h"
#include "camera.h"
#include "depth.h"
#include "fixed.h"
#include "head.h"
#include "image.h"
#include "pointmap.h"
#include "scene_frame.h"
#include "stage_hash.h"
#include "superclusters.h"
#include "undistort.h"
#include "wavelet.h"

void t3r_views_of(const t3r_runtime *rt, t3r_view views[T3R_MAX_VIEWS])
{
    size_t pixels = T3R_PIXELS_(rt->config.width, rt->config.height);
    size_t words = (pixels + 31) / 32;
    for (uint32_t v = 0; v < rt->config.views; v++) {
        uint8_t *colour = (uint8_t *)t3r_buffer_at(rt, T3R_BUFFER_COLOUR) + 3 * pixels * v;
        const t3r_camera *camera = &rt->camera[v];
        views[v] = (t3r_view){
            .width = rt->config.width,
            .height = rt->config.height,
            .colour = {colour, colour + pixels, colour + 2 * pixels},
            .depth = (uint16_t *)t3r_buffer_at(rt, T3R_BUFFER_DEPTH) + pixels * v,
            .confidence = (uint8_t *)t3r_buffer_at(rt, T3R_BUFFER_CONFIDENCE) + pixels * v,
            .texture = (uint16_t *)t3r_buffer_at(rt, T3R_BUFFER_TEXTURE) + pixels * v,
            .key = (uint16_t *)t3r_buffer_at(rt, T3R_BUFFER_KEYS) + pixels * v,
            .label = (uint16_t *)t3r_buffer_at(rt, T3R_BUFFER_LABELS) + pixels * v,
            .mask = (uint32_t *)t3r_buffer_at(rt, T3R_BUFFER_MASK) + words * v,
            .fx_q16 = camera->fx_q16,
            .fy_q16 = camera->fy_q16,
            .cx_q16 = camera->cx_q16,
            .cy_q16 = camera->cy_q16,
            .depth_unit_q40 = rt->depth_unit_q40[v],
        };
        if (v < rt->views) {
            /* In range once there is an analysis; t3r_analyse() asks again with the frame that it chooses. */
            (void)t3r_pose_in_scene(camera, &rt->frame, &views[v].pose);
        }
    }
}

/* --- image ---------------------------------------------------------------------------------------------------- */

t3r_status t3r_develop_view(t3r_runtime *rt, uint32_t index, const t3r_frame *frame, const t3r_camera *camera,
                            t3r_camera *undistorted)
{
    t3r_status status = t3r_image_check(frame);
    if (status == T3R_OK) {
        status = t3r_camera_check(camera);
    }
    if (status != T3R_OK) {
        return status;
    }
    uint32_t width = rt->config.width, height = rt->config.height;
    t3r_camera resized = t3r_camera_resized(camera, frame->width, frame->height, width, height);
    status = t3r_camera_check(&resized);
    if (status != T3R_OK) {
        return status;
    }
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    t3r_view *view = &views[index];

    /* The work buffer: grid, resize rows, a depth plane, three colour planes (trim3r_arena.h). */
    size_t pixels = T3R_PIXELS_(width, height);
    uint8_t *work = t3r_buffer_at(rt, T3R_BUFFER_IMAGE_WORK);
    int32_t *grid = (int32_t *)(void *)work;
    uint8_t *rows = work + T3R_GRID_NODES_(width, height) * 8;
    uint16_t *depth = (uint16_t *)(void *)(rows + t3r_image_work_bytes(width));
    uint8_t *colour = (uint8_t *)(depth + pixels);
    uint8_t *const raw[3] = {colour, colour + pixels, colour + 2 * pixels};

    if (resized.distortion == T3R_DISTORTION_NONE) {
        t3r_image_colour(frame, width, height, view->colour, rows);
        t3r_image_depth(frame, width, height, view->depth);
    } else {
        status = t3r_undistort_grid(&resized, width, height, grid);
        if (status != T3R_OK) {
            return status;
        }
        t3r_image_colour(frame, width, height, raw, rows);
        t3r_image_depth(frame, width, height, depth);
        t3r_undistort_colour(grid, width, height, (const uint8_t *const *)raw, view->colour);
        t3r_undistort_depth(grid, width, height, depth, view->depth);
    }
    t3r_depth_confidence(view);
    resized.distortion = T3R_DISTORTION_NONE;
    for (int i = 0; i < 5; i++) {
        resized.distortion_q24[i] = 0;
    }
    *undistorted = resized;
    return T3R_OK;
}

/* --- superclusters: pixels as points --------------------------------------------------------------------------- */

/* Pixels of all views, view after view, as points x, y, z over the median depth and r, g, b over 255. */
typedef struct pixel_points {
    const t3r_view *views;
    t3r_pointmap maps[T3R_MAX_VIEWS];
    uint32_t pixels;
    int64_t inverse_median_q30; /* of the median depth in scene units */
    int32_t colour_scale_q16;   /* 8-bit level to Q11 */
} pixel_points;

static bool pixel_features(const void *context, uint32_t index, int16_t feature_q11[T3R_DIMENSIONS])
{
    const pixel_points *points = context;
    uint32_t v = index / points->pixels, pixel = index % points->pixels;
    const t3r_view *view = &points->views[v];
    int32_t point[3];
    if (!t3r_point(&points->maps[v], pixel % view->width, pixel / view->width, point)) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        /* |point| <= 2^30, the inverse <= 2^30 */
        int64_t x = t3r_round_shift64(point[i] * points->inverse_median_q30, 39);
        feature_q11[i] = (int16_t)t3r_clamp64(x, -T3R_FEATURE_MOST, T3R_FEATURE_MOST);
        feature_q11[3 + i] = (int16_t)t3r_round_shift32(view->colour[i][pixel] * points->colour_scale_q16, 16);
    }
    return true;
}

static bool step_clusters(void *context, uint32_t done, uint32_t total)
{
    return t3r_progress(context, T3R_STAGE_SUPERCLUSTERS, done, total);
}

static t3r_status cluster_pixels(t3r_runtime *rt, const t3r_view *views)
{
    pixel_points points = {
        .views = views,
        .pixels = rt->config.width * rt->config.height,
        .inverse_median_q30 = ((int64_t)1 << 50) / rt->median_depth_q20,
        .colour_scale_q16 = (int32_t)((rt->config.colour_weight_q8 << 19) / 255),
    };
    for (uint32_t v = 0; v < rt->views; v++) {
        points.maps[v] = t3r_pointmap_of(&views[v], rt->frame.exponent);
    }
    t3r_point_source source = {&points, points.pixels * rt->views, pixel_features};
    t3r_cluster_settings settings = {rt->config.clusters, rt->config.cluster_batches, rt->config.seed};
    t3r_cluster_progress progress = {rt, step_clusters};
    uint32_t valid = t3r_superclusters(&source, &settings, t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS),
                                       t3r_buffer_at(rt, T3R_BUFFER_LABELS),
                                       t3r_buffer_at(rt, T3R_BUFFER_CLUSTER_WORK), &progress);
    return valid == T3R_CLUSTERS_CANCELLED ? T3R_ERR_CANCELLED : T3R_OK;
}

/* --- the way of the data ----------------------------------------------------------------------------------------- */

static uint32_t count_measured(const t3r_runtime *rt, const t3r_view *views)
{
    uint32_t pixels = rt->config.width * rt->config.height, measured = 0;
    for (uint32_t v = 0; v < rt->views; v++) {
        for (uint32_t i = 0; i < pixels; i++) {
            measured += views[v].confidence[i] == T3R_CONFIDENCE_MEASURED;
        }
    }
    return measured;
}

t3r_status t3r_analyse(t3r_runtime *rt)
{
    const t3r_config *config = &rt->config;
    t3r_view views[T3R_MAX_VIEWS];
    for (int i = 0; i < 3; i++) {
        rt->frame.origin_q32[i] = rt->camera[0].position_q32[i];
    }
    t3r_views_of(rt, views);
    t3r_hash_image(rt, views);

    for (uint32_t v = 0; v < rt->views; v++) {
        if (!t3r_progress(rt, T3R_STAGE_DEPTH, v, rt->views)) {
            return T3R_ERR_CANCELLED;
        }
        t3r_depth_fill(&views[v], config->fill_radius);
    }
    rt->valid_points = count_measured(rt, views);
    t3r_hash_depth(rt, views);

    t3r_status status = t3r_scene_frame_choose(views, rt->views, &rt->frame.exponent, &rt->median_depth_q20);
    for (uint32_t v = 0; v < rt->views && status == T3R_OK; v++) {
        status = t3r_pose_in_scene(&rt->camera[v], &rt->frame, &views[v].pose);
    }
    if (status != T3R_OK) {
        return status;
    }
    t3r_hash_pointmap(rt, views);

    for (uint32_t v = 0; v < rt->views; v++) {
        if (!t3r_progress(rt, T3R_STAGE_WAVELET, v, rt->views)) {
            return T3R_ERR_CANCELLED;
        }
        int16_t *plane = t3r_buffer_at(rt, T3R_BUFFER_WAVELET_WORK);
        t3r_wavelet_texture((const uint8_t *const *)views[v].colour, config->width, config->height,
                            config->wavelet_levels, config->wavelet, views[v].texture, plane,
                            plane + T3R_PIXELS_(config->width, config->height));
    }
    t3r_hash_wavelet(rt, views);

    status = cluster_pixels(rt, views);
    if (status != T3R_OK) {
        return status;
    }
    t3r_hash_superclusters(rt, views);

    t3r_cluster_texture(views, rt->views, t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS), config->clusters);
    t3r_blur_texture(views, rt->views);
    rt->analysed = 1;
    return T3R_OK;
}

typedef uint32_t (*head_function)(const t3r_head_input *input, t3r_gaussian *out);

static const head_function heads[T3R_HEAD_COUNT] = {
    [T3R_HEAD_ANALYTIC] = t3r_head_analytic,
    [T3R_HEAD_MOMENT] = t3r_head_moment,
    [T3R_HEAD_NONE] = t3r_head_none,
};

t3r_status t3r_build_scene(t3r_runtime *rt)
{
    t3r_budget_settings settings = {
        .allocation = rt->config.allocation,
        .gaussians = T3R_MIN(rt->config.gaussians, rt->valid_points), /* filled holes compete, but add no budget */
        .keep_percent = rt->config.keep_percent,
        .gamma_q8 = rt->config.gamma_q8,
        .clusters = rt->config.clusters,
        .seed = rt->config.seed,
    };
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    t3r_cluster *clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS);
    t3r_gaussian *scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE);

    rt->has_scene = 0;
    if (!t3r_progress(rt, T3R_STAGE_BUDGET, 0, 1)) {
        return T3R_ERR_CANCELLED;
    }
    t3r_allocate(views, rt->views, &settings, clusters);
    t3r_hash_budget(rt, views);

    rt->gaussians = 0;
    for (uint32_t v = 0; v < rt->views; v++) {
        if (!t3r_progress(rt, T3R_STAGE_HEAD, v, rt->views)) {
            return T3R_ERR_CANCELLED;
        }
        t3r_head_input input = {
            .map = t3r_pointmap_of(&views[v], rt->frame.exponent),
            .view_index = v,
            .settings = &settings,
            .clusters = clusters,
            .work = t3r_buffer_at(rt, T3R_BUFFER_HEAD_WORK),
        };
        rt->gaussians += heads[rt->config.head](&input, scene + rt->gaussians);
    }
    rt->has_scene = 1;
    t3r_hash_scene(rt);
    return T3R_OK;
}
