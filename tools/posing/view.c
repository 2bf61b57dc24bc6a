/* SPDX-License-Identifier: Apache-2.0 */
#include "posing/view.h"

#include <math.h>
#include <stdlib.h>

#include "host/cpu.h"
#include "host/reason.h"

#define EDGE 0.05 /* depths around a feature that differ by more of the nearest one are of two surfaces */

/* A frame after the runtime's image stage: undistorted, at the size that is worked on. */
typedef struct developed {
    uint32_t width, height;
    uint8_t *rgb;
    uint16_t *depth;
    t3r_camera camera;
} developed;

static int develop(const t3r_frame *frame, const t3r_camera *camera, developed *out, char *error, size_t error_bytes)
{
    uint32_t longest = frame->width > frame->height ? frame->width : frame->height;
    uint32_t side = longest > POSE_SIDE_MOST ? POSE_SIDE_MOST : longest < POSE_SIDE_LEAST ? POSE_SIDE_LEAST : longest;
    out->width = (frame->width * side + longest / 2) / longest;
    out->height = (frame->height * side + longest / 2) / longest;
    t3r_config config = t3r_default_config(out->width, out->height, 1, 1);
    t3r_plan_info plan;
    t3r_status status = t3r_plan(&config, &plan);
    if (status != T3R_OK) {
        return t3r_reason(error, error_bytes, "%ux%u pixels are too few", frame->width, frame->height);
    }
    t3r_camera identified = *camera;
    for (int i = 0; i < 4; i++) {
        identified.rotation_q30[i] = i == 0 ? 1 << 30 : 0;
    }
    for (int i = 0; i < 3; i++) {
        identified.position_q32[i] = 0;
    }
    size_t pixels = (size_t)out->width * out->height;
    out->rgb = malloc(pixels * 3);
    out->depth = malloc(pixels * sizeof *out->depth);
    void *arena = NULL;
    t3r_runtime *runtime;
    if (out->rgb == NULL || out->depth == NULL || posix_memalign(&arena, T3R_ARENA_ALIGN, plan.min_bytes) != 0) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    (void)t3r_init(&runtime, arena, plan.min_bytes, &config);
    (void)t3r_set_cpu(runtime, t3r_cpu_features());
    status = t3r_develop(runtime, frame, &identified, out->rgb, out->depth, &out->camera);
    if (status != T3R_OK) {
        (void)t3r_develop_error(status, runtime, frame, &identified, out->rgb, out->depth, &out->camera, error,
                                error_bytes);
    }
    free(arena);
    return status == T3R_OK ? 0 : -1;
}

/* Inverse depth is linear on a plane: bilinear in it. 0 where the 4 x 4 around are not one surface. */
static double depth_at(const developed *d, double x, double y, double unit)
{
    int32_t left = (int32_t)floor(x), top = (int32_t)floor(y);
    if (left < 1 || top < 1 || left + 2 >= (int32_t)d->width || top + 2 >= (int32_t)d->height) {
        return 0;
    }
    uint32_t nearest = UINT16_MAX, farthest = 0;
    for (int32_t v = top - 1; v <= top + 2; v++) {
        for (int32_t u = left - 1; u <= left + 2; u++) {
            uint32_t z = d->depth[(size_t)v * d->width + (size_t)u];
            nearest = z < nearest ? z : nearest;
            farthest = z > farthest ? z : farthest;
        }
    }
    if (nearest == 0 || farthest - nearest > EDGE * nearest) {
        return 0;
    }
    double fx = x - left, fy = y - top;
    const uint16_t *row = d->depth + (size_t)top * d->width + (size_t)left, *next = row + d->width;
    double inverse = (1 - fy) * ((1 - fx) / row[0] + fx / row[1]) + fy * ((1 - fx) / next[0] + fx / next[1]);
    return unit / inverse;
}

static int find(const developed *d, pose_view *out, double unit, char *error, size_t error_bytes)
{
    size_t pixels = (size_t)d->width * d->height;
    pose_features *f = &out->features;
    uint8_t *grey = malloc(pixels);
    f->rays = malloc(FEATURES_MOST * sizeof *f->rays);
    f->depth = malloc(FEATURES_MOST * sizeof *f->depth);
    f->descriptors = malloc(FEATURES_MOST * sizeof *f->descriptors);
    int status = grey != NULL && f->rays != NULL && f->depth != NULL && f->descriptors != NULL
                     ? 0
                     : t3r_reason(error, error_bytes, "out of memory");
    for (size_t i = 0; i < pixels && status == 0; i++) {
        const uint8_t *p = d->rgb + 3 * i;
        grey[i] = (uint8_t)((77 * p[0] + 150 * p[1] + 29 * p[2] + 128) >> 8);
    }
    if (status == 0) {
        status = out->module->find(grey, d->width, d->height, f, error, error_bytes);
    }
    free(grey);
    double fx = ldexp(d->camera.fx_q16, -16), fy = ldexp(d->camera.fy_q16, -16);
    double cx = ldexp(d->camera.cx_q16, -16), cy = ldexp(d->camera.cy_q16, -16);
    f->focal = (fx + fy) / 2;
    for (uint32_t i = 0; i < f->count && status == 0; i++) {
        double x = f->rays[i][0], y = f->rays[i][1];
        f->rays[i][0] = (x - cx) / fx;
        f->rays[i][1] = (y - cy) / fy;
        f->depth[i] = out->measured ? depth_at(d, x, y, unit) : 0;
    }
    return status;
}

int pose_view_make(const t3r_frame *frame, const t3r_camera *camera, pose_view *out, char *error, size_t error_bytes)
{
    *out = (pose_view){.measured = frame->depth != NULL};
    developed d = {0};
    int status = develop(frame, camera, &d, error, error_bytes);
    out->features.enlarged = (double)d.width / frame->width;
    if (status == 0) {
        out->module = pose_module_load(error, error_bytes);
        status =
            out->module != NULL ? find(&d, out, ldexp((double)frame->depth_unit_q40, -40), error, error_bytes) : -1;
    }
    free(d.rgb);
    free(d.depth);
    return status;
}

void pose_view_free(pose_view *view)
{
    free(view->features.rays);
    free(view->features.depth);
    free(view->features.descriptors);
    *view = (pose_view){0};
}
