/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/splat_depth.h"

#include <math.h>
#include <stdlib.h>

#include "core/little_endian.h"
#include "scene/splat_camera.h"

#define MOST_STEPS 65535.0
#define FARTHEST 0x1p22 /* world units; 65535 steps of the largest unit are twice that */

/* The means seen so far at a pixel. */
typedef struct seen_mean {
    float nearest; /* depth of the foremost mean, scene units; 0 = none */
    float depth;   /* depth of the chosen mean */
    float offset;  /* its squared distance from the pixel's centre, pixels squared */
} seen_mean;

/* A mean projected into the camera. */
typedef struct projected_mean {
    size_t pixel;
    float depth, offset;
} projected_mean;

static bool project(const splat_camera *camera, double farthest, const t3r_gaussian *gaussian, projected_mean *out)
{
    double in_camera[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        double from = ldexp(gaussian->position_q20[i], -20) - camera->position[i];
        for (int k = 0; k < 3; k++) {
            in_camera[k] += camera->rotation[3 * i + k] * from;
        }
    }
    const double z = in_camera[2];
    if (gaussian->opacity_q15 < SPLAT_DEPTH_OPACITY_Q15 || !(z > 0 && z < farthest)) {
        return false;
    }
    double x = camera->fx * in_camera[0] / z + camera->cx, y = camera->fy * in_camera[1] / z + camera->cy;
    double column = floor(x + 0.5), row = floor(y + 0.5);
    if (!(column >= 0 && column < camera->width && row >= 0 && row < camera->height)) {
        return false;
    }
    double offset = (x - column) * (x - column) + (y - row) * (y - row);
    *out = (projected_mean){
        .pixel = (size_t)row * camera->width + (size_t)column, .depth = (float)z, .offset = (float)offset};
    return out->depth > 0;
}

/* Finds in two passes the depth of every pixel's foremost mean, then the mean of that surface nearest to the pixel's
 * centre. */
static void see(seen_mean *pixels, const scene_file *scene, const splat_camera *camera, double farthest)
{
    projected_mean m;
    for (uint32_t i = 0; i < scene->count; i++) {
        if (project(camera, farthest, &scene->gaussians[i], &m)) {
            seen_mean *p = &pixels[m.pixel];
            if (p->nearest == 0 || m.depth < p->nearest) {
                p->nearest = m.depth;
            }
        }
    }
    for (uint32_t i = 0; i < scene->count; i++) {
        if (project(camera, farthest, &scene->gaussians[i], &m)) {
            seen_mean *p = &pixels[m.pixel];
            bool of_surface = m.depth <= p->nearest * (1 + (float)SPLAT_DEPTH_SURFACE);
            if (of_surface && (p->depth == 0 || m.offset < p->offset)) {
                p->depth = m.depth;
                p->offset = m.offset;
            }
        }
    }
}

static int ascending(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Chooses the depth step, and returns it in scene units; a scene unit is `world` world units. */
static double settle_unit(splat_depth *out, float *depths, double world)
{
    if (out->seen == 0) {
        out->unit_q40 = 1;
        return 0;
    }
    qsort(depths, out->seen, sizeof *depths, ascending);
    double range = fmin(depths[out->seen - 1], SPLAT_DEPTH_MEDIANS * (double)depths[out->seen / 2]);
    out->unit_q40 = (uint64_t)ceil(ldexp(range * world / MOST_STEPS, 40)); /* 1 to 2^46 */
    return ldexp((double)out->unit_q40, -40) / world;
}

static void count_steps(splat_depth *out, const seen_mean *pixels, size_t count, double unit)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t steps = 0;
        if (pixels[i].depth > 0) {
            steps = (uint32_t)fmin(fmax(floor(pixels[i].depth / unit + 0.5), 1), MOST_STEPS);
        }
        t3r_store_le16(out->steps + 2 * i, (uint16_t)steps);
    }
}

bool splat_depth_make(splat_depth *out, const scene_file *scene, const t3r_camera *camera, uint32_t width,
                      uint32_t height)
{
    const size_t count = (size_t)width * height;
    const double world = ldexp(1, scene->frame.exponent);
    const splat_camera seen_by = splat_camera_of(camera, &scene->frame, width, height);
    seen_mean *pixels = calloc(count, sizeof *pixels);
    float *depths = malloc(count * sizeof *depths);
    *out = (splat_depth){.steps = malloc(count * 2)};
    bool done = pixels != NULL && depths != NULL && out->steps != NULL;
    if (done) {
        see(pixels, scene, &seen_by, FARTHEST / world);
        for (size_t i = 0; i < count; i++) {
            if (pixels[i].depth > 0) {
                depths[out->seen++] = pixels[i].depth;
            }
        }
        count_steps(out, pixels, count, settle_unit(out, depths, world));
    }
    free(depths);
    free(pixels);
    return done;
}
