/* SPDX-License-Identifier: Apache-2.0 */
#include "geometry/view_frame.h"

#include <stdbool.h>

#include "core/camera.h"
#include "core/fixed.h"
#include "geometry/power_of_two.h"

/* Depths up to NEAR units stay, and each doubling beyond adds a unit, for OCTAVES_MOST doublings. Within a doubling the
 * depth is a parabola of the compressed one, whose slope doubles, so that the next one goes on as smoothly. A Gaussian
 * that is seen is at most ASIDE_MOST depths away: its x and y are at most 16 depths. So all are within 1,024 units. */
#define NEAR 8.0
#define OCTAVES_MOST 34
#define ASIDE_MOST 23.0
#define DEPTH_MOST 0x1p300 /* its square is finite */

void view_frame_of(const t3r_camera *camera, const t3r_scene_frame *scene, uint32_t finer, const double limit[2],
                   view_frame *out)
{
    const int32_t room = scene->exponent - T3R_EXPONENT_LEAST;
    const int32_t down = T3R_MIN((int32_t)T3R_MIN(finer, (uint32_t)T3R_EXPONENT_MOST), room);
    *out = (view_frame){
        .frame.exponent = scene->exponent - down, .ratio = power_of_two(down), .limit = {limit[0], limit[1]}};
    t3r_camera_rotation(camera->rotation_q30, out->pose.rotation_q30);
    const double unit = power_of_two(-32 - out->frame.exponent);
    for (int i = 0; i < 3; i++) {
        out->frame.origin_q32[i] = camera->position_q32[i];
        /* both are within 2^62 */
        out->offset[i] = (double)(scene->origin_q32[i] - camera->position_q32[i]) * unit;
        out->forward[i] = out->pose.rotation_q30[3 * i + 2] * 0x1p-30;
    }
}

/* Compresses a depth above 0. */
static double compressed(double depth)
{
    double octaves = 0, rest = depth / NEAR;
    if (rest <= 1) {
        return depth;
    }
    for (; rest > 2 && octaves < OCTAVES_MOST; octaves++) {
        rest /= 2;
    }
    return NEAR + (rest > 2 ? octaves : octaves + __builtin_sqrt(3 * rest - 2) - 1);
}

double view_frame_depth(double depth)
{
    if (depth <= NEAR) {
        return depth;
    }
    const int octaves = (int)(depth - NEAR);
    const double part = depth - NEAR - octaves;
    return NEAR * power_of_two(octaves) * (1 + part * (2 + part) / 3);
}

/* Returns by how much a small change of depth grows when it is compressed, both in parts of their depths. */
static double compression(double depth)
{
    if (depth <= NEAR) {
        return 1;
    }
    const double part = depth - NEAR - (int)(depth - NEAR);
    return (3 + part * (2 + part)) / (2 * (1 + part) * depth);
}

static double held(double value, double most)
{
    return value < -most ? -most : value > most ? most : value;
}

static int32_t rounded(double value)
{
    return (int32_t)(value < 0 ? value - 0.5 : value + 0.5);
}

/* Scales the factor. Widths beyond the format stay at its end. */
static void scale(t3r_gaussian *g, double by, double factor[9])
{
    int exponent = g->factor_exponent;
    for (; by > 1; by /= 2) {
        exponent++;
    }
    for (; by <= 0.5 && exponent > -60; by *= 2) {
        exponent--;
    }
    for (int i = 0; i < 9; i++) {
        factor[i] = g->factor[i] * by;
    }
    g->factor_exponent = (int8_t)T3R_MIN(exponent, 15);
}

/* Multiplies the factor's part along the axis, and moves its columns along the Gaussian's ray, which leaves its
 * projection as it is. ray: to the Gaussian at depth 1, within the limits. */
static void compress(double factor[9], const double forward[3], const double ray[3], double by)
{
    for (int column = 0; column < 3; column++) {
        double along = 0;
        for (int i = 0; i < 3; i++) {
            along += forward[i] * factor[3 * i + column];
        }
        for (int i = 0; i < 3; i++) {
            factor[3 * i + column] += (by - 1) * along * ray[i];
        }
    }
}

static void pack(const double factor[9], t3r_gaussian *g)
{
    double most = 0, by = 1;
    for (int i = 0; i < 9; i++) {
        const double size = factor[i] < 0 ? -factor[i] : factor[i];
        most = size > most ? size : most;
    }
    for (; most * by > 32767 && g->factor_exponent < 15; by /= 2) {
        g->factor_exponent++;
    }
    for (int i = 0; i < 9; i++) {
        g->factor[i] = (int16_t)rounded(held(factor[i] * by, 32767));
    }
}

void view_frame_place(const view_frame *view, double times, t3r_gaussian *gaussian)
{
    double position[3], depth = 0, square = 0;
    for (int i = 0; i < 3; i++) {
        position[i] = gaussian->position_q20[i] * 0x1p-20 * view->ratio * times + view->offset[i];
        depth += position[i] * view->forward[i];
        square += position[i] * position[i];
    }
    const bool is_seen = depth > 0 && depth < DEPTH_MOST && square <= ASIDE_MOST * ASIDE_MOST * depth * depth;
    const double share = is_seen ? compressed(depth) / depth : 0;
    for (int i = 0; i < 3; i++) {
        gaussian->position_q20[i] = is_seen ? rounded(position[i] * share * 0x1p20) : 0;
    }
    double factor[9];
    scale(gaussian, is_seen ? view->ratio * times * share : 1, factor);
    if (is_seen && share < 1) {
        double ray[3] = {view->forward[0], view->forward[1], view->forward[2]};
        for (int axis = 0; axis < 2; axis++) {
            double slope = 0;
            for (int i = 0; i < 3; i++) {
                slope += position[i] / depth * view->pose.rotation_q30[3 * i + axis] * 0x1p-30;
            }
            for (int i = 0; i < 3; i++) {
                ray[i] += held(slope, view->limit[axis]) * view->pose.rotation_q30[3 * i + axis] * 0x1p-30;
            }
        }
        compress(factor, view->forward, ray, compression(depth * share));
    }
    pack(factor, gaussian);
}
