/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/context/nearest_views.h"

#include <math.h>
#include <string.h>

#include "core/camera.h"

#define DEPTH_STEPS (UINT32_C(1) << 16)

view_place view_place_of(const t3r_camera *camera)
{
    int32_t rotation[9];
    t3r_camera_rotation(camera->rotation_q30, rotation);
    view_place place = {.usable = true, .axis_q30 = {rotation[2], rotation[5], rotation[8]}};
    memcpy(place.position_q32, camera->position_q32, sizeof place.position_q32);
    return place;
}

double view_median_depth(const t3r_frame *frame)
{
    uint32_t counts[DEPTH_STEPS] = {0}, valid = 0, step = 0;
    for (uint32_t y = 0; y < frame->depth_height; y++) {
        const uint8_t *row = frame->depth + (size_t)y * frame->depth_stride_bytes;
        for (uint32_t x = 0; x < frame->depth_width; x++) {
            counts[row[2 * x] | (uint32_t)row[2 * x + 1] << 8]++;
        }
    }
    counts[0] = 0; /* not measured */
    for (uint32_t i = 0; i < DEPTH_STEPS; i++) {
        valid += counts[i];
    }
    /* the lower of two middle ones; at most 2^24 pixels */
    for (uint32_t below = 0; step < DEPTH_STEPS - 1 && 2 * (below + counts[step]) < valid; step++) {
        below += counts[step];
    }
    return step * ldexp((double)frame->depth_unit_q40, -40);
}

double view_distance(const view_place *a, const view_place *b, double depth)
{
    double moved = 0, turned = 0;
    for (int i = 0; i < 3; i++) {
        /* |position| < 2^62: the difference fits */
        double d = ldexp((double)(a->position_q32[i] - b->position_q32[i]), -32) / depth;
        double t = ldexp((double)a->axis_q30[i] - b->axis_q30[i], -30);
        moved += d * d;
        turned += t * t;
    }
    return sqrt(moved + turned);
}

static bool among(const uint32_t *frames, uint32_t count, uint32_t frame)
{
    for (uint32_t i = 0; i < count; i++) {
        if (frames[i] == frame) {
            return true;
        }
    }
    return false;
}

uint32_t nearest_views(const view_place *places, uint32_t count, uint32_t target, double depth, uint32_t wanted,
                       uint32_t *context, uint32_t context_count)
{
    while (context_count < wanted) {
        uint32_t nearest = count;
        double least = INFINITY;
        for (uint32_t i = 0; i < count; i++) {
            if (!places[i].usable || i == target || among(context, context_count, i)) {
                continue;
            }
            double distance = view_distance(&places[i], &places[target], depth);
            if (distance < least) {
                nearest = i;
                least = distance;
            }
        }
        if (nearest == count) {
            break;
        }
        context[context_count++] = nearest;
    }
    return context_count;
}
