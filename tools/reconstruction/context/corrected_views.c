/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/context/corrected_views.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "geometry/quaternion.h"
#include "reconstruction/context/nearest_views.h"

#define VIEWS_LEAST 3u
#define NEAREST_SQUARED 1e-12 /* of a camera that stands where a view does: keeps its weight finite */

int corrected_views_of(const t3r_recording *recording, const char *path, const reconstruction_account *account,
                       corrected_views *views)
{
    *views = (corrected_views){.unit = account->unit};
    if (!account->has_cameras || account->context_count < VIEWS_LEAST) {
        return CLI_OK;
    }
    for (uint32_t v = 0; v < account->context_count; v++) {
        t3r_capture_frame frame;
        const int code = recorded_frame_read(recording, path, account->context[v], &frame);
        if (code != CLI_OK) {
            return code;
        }
        views->given[v] = frame.camera;
        views->used[v] = account->camera[v];
    }
    memcpy(views->gain_q14, account->gain_q14, sizeof views->gain_q14);
    views->count = account->context_count;
    return CLI_OK;
}

static void rotation_of(const t3r_camera *camera, double q[4])
{
    for (int i = 0; i < 4; i++) {
        q[i] = ldexp(camera->rotation_q30[i], -30);
    }
}

static void displacement(const t3r_camera *from, const t3r_camera *to, double by[3])
{
    for (int i = 0; i < 3; i++) {
        by[i] = ldexp((double)(to->position_q32[i] - from->position_q32[i]), -32);
    }
}

/* Computes the rotation from one camera's axes to the other's, in the axes of the world, as a quaternion of w >= 0. */
static void turn_between(const t3r_camera *from, const t3r_camera *to, double turn[4])
{
    double a[4], b[4], back[4];
    rotation_of(from, a);
    rotation_of(to, b);
    quaternion_conjugate(a, back);
    quaternion_multiply(b, back, turn);
    for (int i = 0; turn[0] < 0 && i < 4; i++) {
        turn[i] = -turn[i];
    }
}

/* Computes the views' weights, which sum to 1: the reciprocal of the squared distance, softened by that of the nearest
 * view, so that none of several near ones decides alone. */
static void weigh(const corrected_views *views, const t3r_camera *camera, double weight[T3R_MAX_VIEWS])
{
    const view_place place = view_place_of(camera);
    double nearest = INFINITY, sum = 0;
    for (uint32_t v = 0; v < views->count; v++) {
        const view_place given = view_place_of(&views->given[v]);
        const double distance = view_distance(&given, &place, views->unit);
        weight[v] = distance * distance;
        nearest = fmin(nearest, weight[v]);
    }
    for (uint32_t v = 0; v < views->count; v++) {
        weight[v] = 1 / (weight[v] + nearest + NEAREST_SQUARED);
        sum += weight[v];
    }
    for (uint32_t v = 0; v < views->count; v++) {
        weight[v] /= sum;
    }
}

/* Turns the camera by the rotation of this vector part, in the axes of the world, and moves it. */
static void move(t3r_camera *camera, const double v[3], const double by[3])
{
    const double turn[4] = {sqrt(1 - (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])), v[0], v[1], v[2]};
    double q[4], rotation[4];
    rotation_of(camera, q);
    quaternion_multiply(turn, q, rotation);
    quaternion_normalise(rotation);
    for (int i = 0; i < 4; i++) {
        camera->rotation_q30[i] = (int32_t)lrint(ldexp(rotation[i], 30));
    }
    for (int i = 0; i < 3; i++) {
        camera->position_q32[i] += (int64_t)llrint(ldexp(by[i], 32));
    }
}

t3r_camera corrected_views_camera(const corrected_views *views, const t3r_camera *camera, double gain[3])
{
    t3r_camera moved = *camera;
    double weight[T3R_MAX_VIEWS], turned[3] = {0}, shift[3] = {0}, level[3] = {0};
    weigh(views, camera, weight);
    for (uint32_t v = 0; v < views->count; v++) {
        double by[3], turn[4];
        displacement(&views->given[v], &views->used[v], by);
        turn_between(&views->given[v], &views->used[v], turn);
        for (int i = 0; i < 3; i++) {
            turned[i] += weight[v] * turn[1 + i];
            shift[i] += weight[v] * by[i];
            level[i] += weight[v] * ldexp(views->gain_q14[v][i], -14);
        }
    }
    for (int i = 0; i < 3; i++) {
        gain[i] = views->count > 0 ? 1 / level[i] : 1;
    }
    if (views->count > 0) {
        move(&moved, turned, shift);
    }
    return moved;
}

void corrected_views_expose(uint8_t *rgb, size_t pixels, const double gain[3])
{
    const bool changes = gain[0] != 1 || gain[1] != 1 || gain[2] != 1;
    for (size_t i = 0; i < 3 * pixels && changes; i++) {
        rgb[i] = (uint8_t)fmin(rgb[i] * gain[i % 3] + 0.5, 255);
    }
}
