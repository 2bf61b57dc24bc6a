/* SPDX-License-Identifier: Apache-2.0 */
#include "import/poses/lens.h"

#include <math.h>
#include <string.h>

#define STEPS 20    /* iterations of the inverse: each reduces the error of a usual lens by a factor of three or more */
#define MARGIN 1.05 /* around the picture */
#define ENOUGH 1e-9 /* tolerance of the inverse, in units of the focal length */
#define WIDEST 100.0 /* radius in units of the focal length: 89.4 degrees off the axis */

static void distort(const lens *l, const double in[2], double out[2])
{
    const double *d = l->d, x = in[0], y = in[1], r2 = x * x + y * y;
    if (l->model == LENS_RATIONAL) {
        double scale = (1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]))) / (1 + r2 * (d[5] + r2 * (d[6] + r2 * d[7])));
        out[0] = x * scale + 2 * d[2] * x * y + d[3] * (r2 + 2 * x * x);
        out[1] = y * scale + d[2] * (r2 + 2 * y * y) + 2 * d[3] * x * y;
    } else {
        double r = sqrt(r2), angle = atan(r), a2 = angle * angle;
        double scale = r > 0 ? angle * (1 + a2 * (d[0] + a2 * (d[1] + a2 * (d[2] + a2 * d[3])))) / r : 1;
        out[0] = x * scale;
        out[1] = y * scale;
    }
}

void lens_ray(const lens *l, double u, double v, double ray[2])
{
    const double seen[2] = {(u - l->cx) / l->fx, (v - l->cy) / l->fy};
    ray[0] = seen[0];
    ray[1] = seen[1];
    for (int i = 0; i < STEPS && l->model != LENS_PINHOLE; i++) {
        double at[2];
        distort(l, ray, at);
        double r = hypot(ray[0], ray[1]), got = hypot(at[0], at[1]), wanted = hypot(seen[0], seen[1]);
        if (l->model == LENS_EQUIDISTANT) { /* depends on the radius only */
            double scaled = got > 0 ? fmin(r * wanted / got, WIDEST) : wanted;
            ray[0] = wanted > 0 ? seen[0] / wanted * scaled : 0;
            ray[1] = wanted > 0 ? seen[1] / wanted * scaled : 0;
        } else {
            ray[0] += seen[0] - at[0];
            ray[1] += seen[1] - at[1];
        }
        if (fabs(seen[0] - at[0]) + fabs(seen[1] - at[1]) < ENOUGH) {
            return;
        }
    }
}

static void find_radius(lens *l)
{
    const double right = l->width - 0.5, bottom = l->height - 0.5;
    const double corners[4][2] = {{-0.5, -0.5}, {right, -0.5}, {-0.5, bottom}, {right, bottom}};
    l->radius_most = 0;
    for (int i = 0; i < 4; i++) {
        double ray[2];
        lens_ray(l, corners[i][0], corners[i][1], ray);
        double r = hypot(ray[0], ray[1]) * MARGIN;
        l->radius_most = r <= WIDEST ? fmax(l->radius_most, r) : WIDEST; /* also for NaN */
    }
}

bool lens_project(const lens *l, const double point[3], double pixel[2])
{
    if (!(point[2] > 0)) {
        return false;
    }
    double at[2] = {point[0] / point[2], point[1] / point[2]};
    if (!(hypot(at[0], at[1]) <= l->radius_most)) {
        return false;
    }
    if (l->model != LENS_PINHOLE) {
        const double ray[2] = {at[0], at[1]};
        distort(l, ray, at);
    }
    pixel[0] = l->fx * at[0] + l->cx;
    pixel[1] = l->fy * at[1] + l->cy;
    return true;
}

static double number(uint64_t f64)
{
    double value;
    memcpy(&value, &f64, sizeof value);
    return value;
}

const char *lens_of_info(const t3r_ros_camera_info *info, lens *out)
{
    bool equidistant = t3r_text_is(info->distortion_model, "equidistant");
    bool rational =
        t3r_text_is(info->distortion_model, "plumb_bob") || t3r_text_is(info->distortion_model, "rational_polynomial");
    uint32_t used = 0;
    *out = (lens){.width = info->width,
                  .height = info->height,
                  .fx = number(info->k_f64[0]),
                  .fy = number(info->k_f64[4]),
                  .cx = number(info->k_f64[2]),
                  .cy = number(info->k_f64[5])};
    for (uint32_t i = 0; i < info->d_count; i++) {
        double coefficient = number(info->d_f64[i]);
        used = coefficient != 0 ? i + 1 : used;
        if (i < 8) {
            out->d[i] = coefficient;
        }
    }
    if (!(out->fx > 0 && out->fy > 0) || !isfinite(out->fx + out->fy + out->cx + out->cy)) {
        return "K is no camera matrix";
    }
    if (used > 0 && !equidistant && !rational) {
        return "distortion_model is none of plumb_bob, rational_polynomial, equidistant";
    }
    if (used > (equidistant ? 4 : 8)) {
        return "D has more coefficients than its model";
    }
    out->model = equidistant ? LENS_EQUIDISTANT : used > 0 ? LENS_RATIONAL : LENS_PINHOLE;
    find_radius(out);
    return NULL;
}

void lens_reduce(lens *l, uint32_t n)
{
    l->width = floor(l->width / n);
    l->height = floor(l->height / n);
    l->fx /= n;
    l->fy /= n;
    l->cx = (l->cx + 0.5) / n - 0.5; /* the corner stays, half a pixel before the first centre */
    l->cy = (l->cy + 0.5) / n - 0.5;
    find_radius(l);
}

void lens_of_camera(const t3r_camera *camera, uint32_t width, uint32_t height, lens *out)
{
    *out = (lens){.width = width,
                  .height = height,
                  .fx = ldexp(camera->fx_q16, -16),
                  .fy = ldexp(camera->fy_q16, -16),
                  .cx = ldexp(camera->cx_q16, -16),
                  .cy = ldexp(camera->cy_q16, -16)};
    out->model = camera->distortion == T3R_DISTORTION_NONE     ? LENS_PINHOLE
                 : camera->distortion == T3R_DISTORTION_RADTAN ? LENS_RATIONAL
                                                               : LENS_EQUIDISTANT;
    for (int i = 0; i < (out->model == LENS_EQUIDISTANT ? 4 : 5); i++) {
        out->d[i] = ldexp(camera->distortion_q24[i], -24);
    }
    find_radius(out);
}
