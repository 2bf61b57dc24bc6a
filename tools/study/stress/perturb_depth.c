/* SPDX-License-Identifier: Apache-2.0 */
#include <math.h>

#include "study/stress/perturbation.h"
#include "study/stress/random.h"

#define LAST_STEP 65535
#define MOST_DISCS 1000000u

/* Converts a measured depth to steps; it stays measured, so at least one step. */
static uint16_t step_of(double x)
{
    return (uint16_t)(x <= 1 ? 1 : x >= LAST_STEP ? LAST_STEP : floor(x + 0.5));
}

bool perturb_depth_noise(stress_capture *capture, double percent, uint32_t seed)
{
    size_t pixels = (size_t)capture->width * capture->height;
    for (uint32_t v = 0; v < capture->views; v++) {
        uint32_t view_seed = stress_random(seed, v);
        for (size_t i = 0; i < pixels; i++) {
            uint16_t *depth = &capture->view[v].depth[i];
            if (*depth != 0) {
                *depth = step_of(*depth * (1 + percent / 100 * stress_normal(view_seed, (uint32_t)i)));
            }
        }
    }
    return true;
}

bool perturb_depth_scale(stress_capture *capture, double percent, uint32_t seed)
{
    (void)seed;
    size_t pixels = (size_t)capture->width * capture->height;
    for (uint32_t v = 0; v < capture->views; v++) {
        for (size_t i = 0; i < pixels; i++) {
            uint16_t *depth = &capture->view[v].depth[i];
            *depth = *depth == 0 ? 0 : step_of(*depth * (1 + percent / 100));
        }
    }
    return true;
}

bool perturb_lattice(stress_capture *capture, double pitch, uint32_t seed)
{
    (void)seed;
    uint32_t step = pitch < 1 ? 1 : (uint32_t)pitch;
    for (uint32_t v = 0; v < capture->views; v++) {
        for (uint32_t y = 0; y < capture->height; y++) {
            for (uint32_t x = 0; x < capture->width; x++) {
                if (x % step != 0 || y % step != 0) {
                    capture->view[v].depth[(size_t)y * capture->width + x] = 0;
                }
            }
        }
    }
    return true;
}

static void punch(const stress_capture *capture, uint16_t *depth, double x, double y, double radius)
{
    for (uint32_t row = 0; row < capture->height; row++) {
        for (uint32_t column = 0; column < capture->width; column++) {
            double dx = column - x, dy = row - y;
            if (dx * dx + dy * dy <= radius * radius) {
                depth[(size_t)row * capture->width + column] = 0;
            }
        }
    }
}

static size_t without(const stress_capture *capture, const uint16_t *depth)
{
    size_t count = 0;
    for (size_t i = 0; i < (size_t)capture->width * capture->height; i++) {
        count += depth[i] == 0;
    }
    return count;
}

/* Removes depth in discs from at least this percentage of the pixels that have it; the last disc may exceed it. */
bool perturb_blobs(stress_capture *capture, double percent, uint32_t seed)
{
    size_t pixels = (size_t)capture->width * capture->height;
    double side = capture->width < capture->height ? capture->width : capture->height;
    for (uint32_t v = 0; v < capture->views; v++) {
        uint16_t *depth = capture->view[v].depth;
        uint32_t view_seed = stress_random(seed, v);
        size_t before = without(capture, depth);
        double most = (double)before + percent / 100 * (double)(pixels - before);
        for (uint32_t disc = 0; disc < MOST_DISCS && (double)without(capture, depth) < most; disc++) {
            punch(capture, depth, stress_uniform(view_seed, 3 * disc) * capture->width,
                  stress_uniform(view_seed, 3 * disc + 1) * capture->height,
                  side * (1 + 2 * stress_uniform(view_seed, 3 * disc + 2)) / 24);
        }
    }
    return true;
}

/* Sets each pixel's depth to `steps` with a probability of this percentage. */
static void replace(stress_capture *capture, double percent, uint32_t seed, uint16_t steps)
{
    size_t pixels = (size_t)capture->width * capture->height;
    for (uint32_t v = 0; v < capture->views; v++) {
        uint32_t view_seed = stress_random(seed, v);
        for (size_t i = 0; i < pixels; i++) {
            if (stress_uniform(view_seed, (uint32_t)i) * 100 < percent) {
                capture->view[v].depth[i] = steps;
            }
        }
    }
}

bool perturb_dropouts(stress_capture *capture, double percent, uint32_t seed)
{
    replace(capture, percent, seed, 0);
    return true;
}

bool perturb_near(stress_capture *capture, double percent, uint32_t seed)
{
    replace(capture, percent, seed, 1);
    return true;
}

bool perturb_far(stress_capture *capture, double percent, uint32_t seed)
{
    replace(capture, percent, seed, LAST_STEP);
    return true;
}
