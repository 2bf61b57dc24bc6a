/* The runtime's own analysis, budget and head features for the training, so that a head learns from what it will see.
 */
#include <stdlib.h>

#include "head.h"
#include "head_features.h"
#include "pipeline.h"
#include "state.h"

typedef struct prepare_settings {
    uint32_t gaussians, allocation, gamma_q8, clusters, cluster_batches, seed;
} prepare_settings;

/* What is known of a retained point. Lengths in metres, axes those of the camera. */
typedef struct prepared_point {
    float x, y;                       /* pixel */
    float spacing;                    /* of retained points about it, pixels */
    float position[3];                /* on the surface */
    float tangent_u[3], tangent_v[3]; /* of the surface, metres a pixel */
} prepared_point;

static float metres(const t3r_runtime *rt, int32_t value, int fraction)
{
    double x = value;
    for (int i = rt->frame.exponent - fraction; i != 0; i += i < 0 ? 1 : -1) {
        x = i < 0 ? x / 2 : x * 2;
    }
    return (float)x;
}

static void note_points(const t3r_runtime *rt, const t3r_head_input *input, prepared_point *points)
{
    const t3r_view *view = input->map.view;
    for (uint32_t y = 0; y < view->height; y++) {
        for (uint32_t x = 0; x < view->width; x++) {
            size_t i = (size_t)y * view->width + x;
            if (!t3r_retained(view, i)) {
                continue;
            }
            int32_t at[3], tu[3], tv[3];
            (void)t3r_point(&input->map, x, y, at);
            (void)t3r_tangents(&input->map, x, y, tu, tv);
            *points = (prepared_point){.x = (float)x, .y = (float)y};
            points->spacing = (float)t3r_spacing_q12(input, i) / 4096.0f;
            for (int k = 0; k < 3; k++) {
                points->position[k] = metres(rt, at[k], 20);
                points->tangent_u[k] = metres(rt, tu[k], 24);
                points->tangent_v[k] = metres(rt, tv[k], 24);
            }
            points++;
        }
    }
}

/* One picture, [height][width][3], with its depth in millimetres and its fx, fy, cx, cy, taken through the runtime as
 * the only context view. Results: `features` [height][width][T3R_FEATURES]; `confidence` [height][width]; `points`, as
 * many as are returned, in raster order. A negative t3r_status when the runtime refuses. */
int32_t prepare(uint32_t width, uint32_t height, const uint8_t *rgb, const uint16_t *depth, const double *intrinsics,
                const prepare_settings *settings, int8_t *features, uint8_t *confidence, prepared_point *points,
                int32_t *valid)
{
    t3r_config config = t3r_default_config(width, height, 1, settings->gaussians);
    config.allocation = (t3r_allocation)settings->allocation;
    config.gamma_q8 = settings->gamma_q8;
    config.clusters = settings->clusters;
    config.cluster_batches = settings->cluster_batches;
    config.seed = settings->seed;
    config.head = T3R_HEAD_NONE;
    config.keep_analysis = 1;
    config.refinements = 0; /* of the scene nothing is read */
    t3r_plan_info plan;
    t3r_status status = t3r_plan(&config, &plan);
    if (status != T3R_OK) {
        return status;
    }
    void *arena =
        aligned_alloc(T3R_ARENA_ALIGN, (plan.min_bytes + T3R_ARENA_ALIGN - 1) / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN);
    t3r_runtime *rt = NULL;
    t3r_frame frame = {.format = T3R_PIXEL_RGB24,
                       .width = width,
                       .height = height,
                       .planes = {rgb},
                       .stride_bytes = {3 * width},
                       .depth = (const uint8_t *)depth,
                       .depth_width = width,
                       .depth_height = height,
                       .depth_stride_bytes = 2 * width,
                       .depth_unit_q40 = 1099511628};
    t3r_camera camera = {.fx_q16 = (int32_t)(intrinsics[0] * 65536),
                         .fy_q16 = (int32_t)(intrinsics[1] * 65536),
                         .cx_q16 = (int32_t)(intrinsics[2] * 65536),
                         .cy_q16 = (int32_t)(intrinsics[3] * 65536),
                         .rotation_q30 = {1 << 30, 0, 0, 0}};
    t3r_scene scene;
    if (arena == NULL) {
        return T3R_ERR_ARENA;
    }
    if ((status = t3r_init(&rt, arena, plan.min_bytes, &config)) != T3R_OK ||
        (status = t3r_add_view(rt, &frame, &camera)) != T3R_OK || (status = t3r_reconstruct(rt, &scene)) != T3R_OK) {
        free(arena);
        return status;
    }
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    const t3r_budget_settings budget = t3r_budget_settings_of(rt, views);
    const t3r_head_input input = t3r_head_input_of(rt, views, 0, &budget);
    for (uint32_t y = 0; y < height; y++) {
        t3r_head_features(&input, y, features + (size_t)y * width * T3R_FEATURES);
    }
    for (size_t i = 0; i < (size_t)width * height; i++) {
        confidence[i] = views[0].confidence[i];
    }
    note_points(rt, &input, points);
    int32_t count = (int32_t)scene.count;
    *valid = (int32_t)scene.valid_points;
    free(arena);
    return count;
}
