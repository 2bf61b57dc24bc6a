/* SPDX-License-Identifier: Apache-2.0 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study/stress/perturbation.h"
#include "study/stress/random.h"

#define RADIANS 0.017453292519943295

static int by_size(const void *a, const void *b)
{
    const uint16_t x = *(const uint16_t *)a, y = *(const uint16_t *)b;
    return (x > y) - (x < y);
}

/* Returns the median depth in world units over the first context view; 1 if it has no depth, negative if out of
 * memory. */
static double median_depth(const stress_capture *capture)
{
    size_t pixels = (size_t)capture->width * capture->height, count = 0;
    uint16_t *sorted = malloc(pixels * sizeof *sorted);
    if (sorted == NULL) {
        return -1;
    }
    for (size_t i = 0; i < pixels; i++) {
        if (capture->view[0].depth[i] != 0) {
            sorted[count++] = capture->view[0].depth[i];
        }
    }
    qsort(sorted, count, sizeof *sorted, by_size);
    double median = count == 0 ? 1 : sorted[count / 2] * capture->depth_unit;
    free(sorted);
    return median;
}

static void direction(double d[3], uint32_t seed)
{
    double squared = 0;
    for (uint32_t i = 0; i < 3; i++) {
        d[i] = stress_normal(seed, i);
        squared += d[i] * d[i];
    }
    for (uint32_t i = 0; i < 3; i++) {
        d[i] = squared > 0 ? d[i] / sqrt(squared) : i == 0;
    }
}

/* Replaces q by r q. */
static void turn(double q[4], const double r[4])
{
    const double p[4] = {q[0], q[1], q[2], q[3]};
    q[0] = r[0] * p[0] - r[1] * p[1] - r[2] * p[2] - r[3] * p[3];
    q[1] = r[0] * p[1] + r[1] * p[0] + r[2] * p[3] - r[3] * p[2];
    q[2] = r[0] * p[2] - r[1] * p[3] + r[2] * p[0] + r[3] * p[1];
    q[3] = r[0] * p[3] + r[1] * p[2] - r[2] * p[1] + r[3] * p[0];
}

bool perturb_pose(stress_capture *capture, double amount, uint32_t seed)
{
    if (!(amount > 0)) {
        return true; /* even a turn by 0 could round */
    }
    double median = median_depth(capture);
    for (uint32_t v = 0; v < capture->views && median >= 0; v++) {
        t3r_recorded_camera *camera = &capture->view[v].camera;
        uint32_t view_seed = stress_random(seed, v);
        double axis[3], way[3], half = amount * RADIANS / 2;
        direction(axis, view_seed);
        direction(way, view_seed + 1);
        turn(camera->rotation,
             (const double[4]){cos(half), sin(half) * axis[0], sin(half) * axis[1], sin(half) * axis[2]});
        for (int i = 0; i < 3; i++) {
            camera->position[i] += way[i] * median * amount / 100;
        }
    }
    return median >= 0;
}

bool perturb_intrinsics(stress_capture *capture, double percent, uint32_t seed)
{
    (void)seed;
    for (uint32_t v = 0; v < capture->views; v++) {
        capture->view[v].camera.fx *= 1 + percent / 100;
        capture->view[v].camera.fy *= 1 + percent / 100;
    }
    return true;
}

bool perturb_huge(stress_capture *capture, double exponent, uint32_t seed)
{
    (void)seed;
    for (uint32_t v = 0; v <= capture->views && exponent > 0; v++) {
        for (int i = 0; i < 3; i++) {
            capture->view[v].camera.position[i] += pow(10, exponent);
        }
    }
    return true;
}

static double between(double a, double b, double share)
{
    return a + (b - a) * share;
}

/* Samples bilinearly, borders repeated. */
static void sample_colour(const stress_capture *capture, const uint8_t *rgb, double x, double y, uint8_t out[3])
{
    double right = capture->width - 1, bottom = capture->height - 1;
    x = x < 0 ? 0 : x > right ? right : x;
    y = y < 0 ? 0 : y > bottom ? bottom : y;
    size_t x0 = (size_t)x, y0 = (size_t)y;
    size_t x1 = x0 + 1 < capture->width ? x0 + 1 : x0, y1 = y0 + 1 < capture->height ? y0 + 1 : y0;
    const uint8_t *top = rgb + y0 * capture->width * 3, *low = rgb + y1 * capture->width * 3;
    for (size_t c = 0; c < 3; c++) {
        double above = between(top[x0 * 3 + c], top[x1 * 3 + c], x - (double)x0);
        double below = between(low[x0 * 3 + c], low[x1 * 3 + c], x - (double)x0);
        out[c] = (uint8_t)floor(between(above, below, y - (double)y0) + 0.5);
    }
}

/* Returns the depth along the turned camera's z of the point at (x, y); 0 outside. */
static uint16_t sample_depth(const stress_capture *capture, const uint16_t *depth, double x, double y, double z)
{
    double column = floor(x + 0.5), row = floor(y + 0.5);
    if (column < 0 || row < 0 || column >= capture->width || row >= capture->height) {
        return 0;
    }
    double steps = depth[(size_t)row * capture->width + (size_t)column] / z;
    return (uint16_t)(steps >= 65535 ? 65535 : floor(steps + 0.5));
}

/* Samples row y as a camera sees it that has turned by (y / (height - 1) - 1/2) `degrees` about its own y. */
static void roll(const stress_capture *capture, const stress_view *from, double degrees, uint8_t *rgb, uint16_t *depth)
{
    const t3r_recorded_camera *c = &from->camera;
    for (uint32_t y = 0; y < capture->height; y++) {
        double angle = degrees * RADIANS * (y / (capture->height - 1.0) - 0.5);
        double cosine = cos(angle), sine = sin(angle);
        for (uint32_t x = 0; x < capture->width; x++) {
            size_t i = (size_t)y * capture->width + x;
            double dx = (x - c->cx) / c->fx, dy = (y - c->cy) / c->fy;
            double z = cosine - sine * dx; /* > 0: the turn is small against a right angle */
            double at_x = (cosine * dx + sine) / z * c->fx + c->cx, at_y = dy / z * c->fy + c->cy;
            sample_colour(capture, from->rgb, at_x, at_y, &rgb[i * 3]);
            depth[i] = sample_depth(capture, from->depth, at_x, at_y, z);
        }
    }
}

bool perturb_rolling(stress_capture *capture, double degrees, uint32_t seed)
{
    (void)seed;
    if (!(degrees > 0)) {
        return true; /* pixels would be sampled at their own places, up to rounding */
    }
    size_t pixels = (size_t)capture->width * capture->height;
    uint8_t *rgb = malloc(pixels * 3);
    uint16_t *depth = malloc(pixels * sizeof *depth);
    bool done = rgb != NULL && depth != NULL;
    for (uint32_t v = 0; v < capture->views && done; v++) {
        roll(capture, &capture->view[v], degrees, rgb, depth);
        memcpy(capture->view[v].rgb, rgb, pixels * 3);
        memcpy(capture->view[v].depth, depth, pixels * sizeof *depth);
    }
    free(rgb);
    free(depth);
    return done;
}
