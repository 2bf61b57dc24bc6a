/* SPDX-License-Identifier: Apache-2.0 */
#include "study/stress/scene.h"

#include <math.h>
#include <stddef.h>

#define FOCAL_PER_WIDTH 0.8660254037844386 /* 1 / (2 tan 30 degrees) */
#define HALF_BASELINE 0.15
#define SUBSAMPLES 2 /* per side */

static const stress_scene scenes[] = {
    {"scene-plane", "px", {16, 8, 4}, "a chequered, speckled plane: side of its squares", stress_plane},
    {"scene-wall", "deg", {15, 35, 55}, "a blank wall: its slant", stress_wall},
    {"scene-bars", "px", {8, 4, 2}, "thin bars before a wall: their width", stress_bars},
    {"scene-foliage", "px", {16, 8, 4}, "leaves at all depths: their length", stress_foliage},
    {"scene-mirror", "%", {25, 50, 90}, "a mirror, measured as a surface: its share", stress_mirror},
};

const stress_scene *stress_scene_at(uint32_t index)
{
    return index < sizeof scenes / sizeof *scenes ? &scenes[index] : NULL;
}

static void draw(stress_capture *capture, uint32_t v, const stress_scene *scene, double strength)
{
    const t3r_recorded_camera *c = &capture->view[v].camera;
    for (uint32_t y = 0; y < capture->height; y++) {
        for (uint32_t x = 0; x < capture->width; x++) {
            size_t i = (size_t)y * capture->width + x;
            double sum[3] = {0, 0, 0}, dx = (x - c->cx) / c->fx, dy = (y - c->cy) / c->fy;
            for (int s = 0; s < SUBSAMPLES * SUBSAMPLES; s++) {
                stress_hit hit = scene->trace(c->position[0], c->position[1], dx + (s % 2 - 0.5) / SUBSAMPLES / c->fx,
                                              dy + (s / 2 - 0.5) / SUBSAMPLES / c->fy, 1 / c->fx, strength);
                for (int k = 0; k < 3; k++) {
                    sum[k] += hit.rgb[k] < 0 ? 0 : hit.rgb[k] > 255 ? 255 : hit.rgb[k];
                }
            }
            for (int k = 0; k < 3; k++) {
                capture->view[v].rgb[i * 3 + (size_t)k] = (uint8_t)(sum[k] / (SUBSAMPLES * SUBSAMPLES) + 0.5);
            }
            double depth = scene->trace(c->position[0], c->position[1], dx, dy, 1 / c->fx, strength).depth;
            capture->view[v].depth[i] = (uint16_t)(depth * 1000 > 65535 ? 65535 : depth * 1000 + 0.5);
        }
    }
}

bool stress_scene_draw(stress_capture *capture, const stress_scene *scene, double strength, uint32_t width,
                       uint32_t height)
{
    static const double place[] = {-HALF_BASELINE, HALF_BASELINE, 0};
    if (!stress_capture_open(capture, width, height, 2, 0.001)) {
        return false;
    }
    for (uint32_t v = 0; v < 3; v++) {
        capture->view[v].camera = (t3r_recorded_camera){.width = width,
                                                        .height = height,
                                                        .fx = width * FOCAL_PER_WIDTH,
                                                        .fy = width * FOCAL_PER_WIDTH,
                                                        .cx = (width - 1) / 2.0,
                                                        .cy = (height - 1) / 2.0,
                                                        .position = {place[v], 0, 0},
                                                        .rotation = {1, 0, 0, 0}};
        draw(capture, v, scene, strength);
    }
    return true;
}
