/* SPDX-License-Identifier: Apache-2.0 */
/* The runtime's own analysis, budget and head features, so that a head is trained on its actual inputs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/fixed.h"
#include "head/head.h"
#include "head/head_features.h"
#include "head/head_views.h"
#include "prepare_rival.h"
#include "stages.h"
#include "state/state.h"
#include "trim3r_heads.h"

typedef struct prepare_settings {
    uint32_t gaussians, allocate, gamma_q8, clusters, cluster_batches, seed;
    uint32_t rival; /* a method_kind: retains the points whose Gaussians the rival keeps of the scene that the shipped
                       `small` makes of all points; METHOD_TRIM3R: retains by the allocation */
} prepare_settings;

/* Context views, one after the other. */
typedef struct prepare_views {
    uint32_t count, width, height;
    const uint8_t *rgb;       /* [count][height][width][3] */
    const uint16_t *depth;    /* [count][height][width], mm, 0: none */
    const double *intrinsics; /* [count][4]: fx, fy, cx, cy */
    const double *poses;      /* [count][7]: camera to world, unit quaternion w x y z, centre in metres */
} prepare_views;

/* A retained point. Lengths are in metres, axes are those of the point's camera. */
typedef struct prepared_point {
    float x, y;                       /* pixel */
    float spacing;                    /* mean distance of the retained points around it, pixels */
    float position[3];                /* on the surface */
    float tangent_u[3], tangent_v[3]; /* tangents of the surface, metres a pixel */
} prepared_point;

static float metres(const t3r_runtime *rt, int32_t value, int fraction)
{
    double x = value;
    for (int i = rt->frame.exponent - fraction; i != 0; i += i < 0 ? 1 : -1) {
        x = i < 0 ? x / 2 : x * 2;
    }
    return (float)x;
}

static uint32_t note_points(const t3r_runtime *rt, const t3r_head_input *input, prepared_point *points)
{
    t3r_view view = *input->map.view;
    view.pose = (t3r_pose){.rotation_q30 = {1 << 30, 0, 0, 0, 1 << 30, 0, 0, 0, 1 << 30}};
    t3r_pointmap map = input->map;
    map.view = &view;
    uint32_t count = 0;
    for (uint32_t y = 0; y < view.height; y++) {
        for (uint32_t x = 0; x < view.width; x++) {
            size_t i = (size_t)y * view.width + x;
            if (!t3r_retained(&view, i)) {
                continue;
            }
            int32_t at[3], tu[3], tv[3];
            (void)t3r_point(&map, x, y, at);
            (void)t3r_tangents(&map, x, y, tu, tv);
            prepared_point *point = &points[count++];
            *point = (prepared_point){.x = (float)x, .y = (float)y};
            point->spacing = (float)t3r_spacing_q12(input, i) / 4096.0f;
            for (int k = 0; k < 3; k++) {
                point->position[k] = metres(rt, at[k], 20);
                point->tangent_u[k] = metres(rt, tu[k], 24);
                point->tangent_v[k] = metres(rt, tv[k], 24);
            }
        }
    }
    return count;
}

/* A running runtime and its memory. */
typedef struct preparation {
    void *arena;
    t3r_runtime *rt;
    t3r_camera cameras[T3R_MAX_VIEWS];
    t3r_scene scene;
    uint16_t *importance; /* for a rival: one plane per view */
} preparation;

static uint32_t measured_points(const prepare_views *views)
{
    uint32_t count = 0;
    for (size_t i = 0; i < (size_t)views->count * views->width * views->height; i++) {
        count += views->depth[i] != 0;
    }
    return count;
}

static t3r_config config_of(const prepare_views *views, const prepare_settings *settings)
{
    bool rival = settings->rival != METHOD_TRIM3R;
    uint32_t gaussians = rival ? measured_points(views) : settings->gaussians;
    t3r_config config = t3r_default_config(views->width, views->height, views->count, gaussians);
    config.keep_analysis = 1;
    config.exposure = 0; /* the training's pictures keep their exposure */
    config.rim = 0;      /* all Gaussians are points */
    if (rival) {         /* the settings with which `trim3r eval` makes the scene that rivals rank */
        config.head = T3R_HEAD_LEARNED;
        return config;
    }
    config.allocate = (t3r_allocation)settings->allocate;
    config.gamma_q8 = settings->gamma_q8;
    config.clusters = settings->clusters;
    config.cluster_batches = settings->cluster_batches;
    config.seed = settings->seed;
    config.refine = 0; /* the scene itself is not used */
    return config;
}

static t3r_status open_runtime(preparation *p, const t3r_config *config)
{
    t3r_plan_info plan;
    t3r_status status = t3r_plan(config, &plan);
    if (status != T3R_OK) {
        return status;
    }
    size_t bytes = config->refine > 0 ? plan.bytes : plan.min_bytes;
    p->arena = aligned_alloc(T3R_ARENA_ALIGN, (bytes + T3R_ARENA_ALIGN - 1) / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN);
    if (p->arena == NULL) {
        return T3R_ERR_ARENA;
    }
    status = t3r_init(&p->rt, p->arena, bytes, config);
    status = status == T3R_OK ? t3r_set_cpu(p->rt, t3r_cpu_found()) : status;
    return status == T3R_OK && config->head == T3R_HEAD_LEARNED
               ? t3r_bind_head(p->rt, t3r_head_small, t3r_head_small_bytes)
               : status;
}

static t3r_status add_view(preparation *p, const prepare_views *views, uint32_t v)
{
    const size_t pixels = (size_t)views->width * views->height;
    const double *intrinsics = views->intrinsics + 4 * (size_t)v, *pose = views->poses + 7 * (size_t)v;
    t3r_frame frame = {.format = T3R_PIXEL_RGB24,
                       .width = views->width,
                       .height = views->height,
                       .planes = {views->rgb + 3 * pixels * v},
                       .stride_bytes = {3 * views->width},
                       .depth = (const uint8_t *)(views->depth + pixels * v),
                       .depth_width = views->width,
                       .depth_height = views->height,
                       .depth_stride_bytes = 2 * views->width,
                       .depth_unit_q40 = 1099511628};
    p->cameras[v] = (t3r_camera){.width = views->width,
                                 .height = views->height,
                                 .fx_q16 = (int32_t)(intrinsics[0] * 65536),
                                 .fy_q16 = (int32_t)(intrinsics[1] * 65536),
                                 .cx_q16 = (int32_t)(intrinsics[2] * 65536),
                                 .cy_q16 = (int32_t)(intrinsics[3] * 65536)};
    for (int i = 0; i < 4; i++) {
        p->cameras[v].rotation_q30[i] = (int32_t)lround(pose[i] * (1 << 30));
    }
    for (int i = 0; i < 3; i++) {
        p->cameras[v].position_q32[i] = llround(pose[4 + i] * 4294967296.0);
    }
    return t3r_add_view(p->rt, &frame, &p->cameras[v]);
}

/* Retains the points that the rival keeps of the scene of all points. */
static t3r_status retain_for(preparation *p, const prepare_views *views, const prepare_settings *settings)
{
    const size_t pixels = (size_t)views->width * views->height;
    uint32_t count = T3R_MIN(settings->gaussians, p->scene.count);
    uint16_t *planes[T3R_MAX_VIEWS];
    const uint16_t *given[T3R_MAX_VIEWS];
    p->importance = malloc(views->count * pixels * sizeof *p->importance);
    if (p->importance == NULL) {
        return T3R_ERR_ARENA;
    }
    for (uint32_t v = 0; v < views->count; v++) {
        given[v] = planes[v] = p->importance + pixels * v;
    }
    t3r_status status = prepare_rival(p->rt, &p->scene, p->cameras, views->count, (method_kind)settings->rival, count,
                                      settings->seed, planes);
    const t3r_request request = {.gaussians = count, .importance = given, .importance_stride_bytes = 2 * views->width};
    return status == T3R_OK ? t3r_rebuild(p->rt, &request, &p->scene) : status;
}

static t3r_status analyse(preparation *p, const prepare_views *views, const prepare_settings *settings)
{
    const t3r_config config = config_of(views, settings);
    t3r_status status = open_runtime(p, &config);
    for (uint32_t v = 0; v < views->count && status == T3R_OK; v++) {
        status = add_view(p, views, v);
    }
    status = status == T3R_OK ? t3r_reconstruct(p->rt, NULL, &p->scene) : status;
    return status == T3R_OK && settings->rival != METHOD_TRIM3R ? retain_for(p, views, settings) : status;
}

/* Prepares pictures together through the runtime. Results, view after view: `features` [height][width][T3R_FEATURES];
 * `confidence` [height][width]; `points` of all views without gaps, in raster order, counts[views] of each. Returns 0,
 * or the runtime's negative t3r_status. */
int32_t prepare(const prepare_views *views, const prepare_settings *settings, int8_t *features, uint8_t *confidence,
                prepared_point *points, uint32_t *counts)
{
    preparation p = {.arena = NULL};
    t3r_status status = analyse(&p, views, settings);
    if (status == T3R_OK) {
        const size_t pixels = (size_t)views->width * views->height;
        t3r_view planes[T3R_MAX_VIEWS];
        t3r_views_of(p.rt, planes);
        const t3r_budget_settings budget = t3r_budget_settings_of(p.rt, planes);
        for (uint32_t v = 0; v < views->count; v++) {
            const t3r_head_input input = t3r_head_input_of(p.rt, planes, v, &budget);
            for (uint32_t y = 0; y < views->height; y++) {
                t3r_head_features(&input, y, features + (pixels * v + (size_t)y * views->width) * T3R_FEATURES);
            }
            for (size_t i = 0; i < pixels; i++) {
                confidence[pixels * v + i] = t3r_confidence_of(planes[v].validity[i]);
            }
            counts[v] = note_points(p.rt, &input, points);
            points += counts[v];
        }
    }
    free(p.importance);
    free(p.arena);
    return status;
}
