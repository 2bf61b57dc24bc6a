/* SPDX-License-Identifier: Apache-2.0 */
#include "import/frames/straighten.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/little_endian.h"
#include "host/reason.h"
#include "messages/fixed_camera.h"
#include "messages/fixed_double.h"

#define FOLD_STEP (1.0 / 256)
#define FOLD_STEPS 2048 /* to 82.9 degrees off the axis */

bool posed_is_bent(const posed_intrinsics *in)
{
    bool bent = false;
    for (uint32_t i = 0; i < sizeof in->coefficients / sizeof *in->coefficients; i++) {
        int32_t q24;
        bent = bent || (i < 5 ? !t3r_fixed_coefficient(t3r_double_bits(in->coefficients[i]), in->distortion, i, &q24)
                              : in->coefficients[i] != 0);
    }
    return bent;
}

lens posed_lens(const posed_intrinsics *in, const t3r_recorded_camera *camera)
{
    lens out = {.width = camera->width,
                .height = camera->height,
                .fx = camera->fx,
                .fy = camera->fy,
                .cx = camera->cx,
                .cy = camera->cy,
                .model = in->distortion == T3R_DISTORTION_FISHEYE ? LENS_EQUIDISTANT : LENS_RATIONAL};
    memcpy(out.d, in->coefficients, sizeof out.d);
    return out;
}

/* Returns the lens with its radius bounded by the fold: where a longer radius is drawn nearer to the axis. */
static lens within_fold(const lens *l)
{
    lens out = *l, radial = *l;
    double before = 0;
    if (radial.model == LENS_RATIONAL) {
        radial.d[2] = radial.d[3] = 0; /* tangential */
    }
    radial.radius_most = HUGE_VAL;
    out.radius_most = FOLD_STEP * FOLD_STEPS;
    for (int i = 1; i <= FOLD_STEPS; i++) {
        double pixel[2];
        (void)lens_project(&radial, (const double[3]){i * FOLD_STEP, 0, 1}, pixel);
        const double now = (pixel[0] - l->cx) / l->fx;
        if (!(now > before)) {
            out.radius_most = (i - 1) * FOLD_STEP;
            break;
        }
        before = now;
    }
    return out;
}

/* Returns the samples at x, y of 8 bits, interpolated. */
static void interpolate(const picture *p, double x, double y, uint8_t *out)
{
    const double left = fmin(fmax(floor(x), 0), p->width - 1.0), top = fmin(fmax(floor(y), 0), p->height - 1.0);
    const double across = fmin(fmax(x - left, 0), 1), down = fmin(fmax(y - top, 0), 1);
    const size_t x0 = (size_t)left, y0 = (size_t)top, x1 = x0 + 1 < p->width ? x0 + 1 : x0,
                 y1 = y0 + 1 < p->height ? y0 + 1 : y0;
    const uint8_t *samples = p->samples;
    for (size_t c = 0; c < p->channels; c++) {
        const double above = samples[(y0 * p->width + x0) * p->channels + c] * (1 - across) +
                             samples[(y0 * p->width + x1) * p->channels + c] * across;
        const double below = samples[(y1 * p->width + x0) * p->channels + c] * (1 - across) +
                             samples[(y1 * p->width + x1) * p->channels + c] * across;
        out[c] = (uint8_t)floor(above * (1 - down) + below * down + 0.5);
    }
}

/* Finds the place in a picture of width x height that the pinhole's pixel (x, y) sees; false: none. */
static bool source_of(const lens *l, uint32_t width, uint32_t height, uint32_t x, uint32_t y, double at[2])
{
    const double scale[2] = {width / l->width, height / l->height};
    const double ray[3] = {((x + 0.5) / scale[0] - 0.5 - l->cx) / l->fx, ((y + 0.5) / scale[1] - 0.5 - l->cy) / l->fy,
                           1};
    if (!lens_project(l, ray, at)) {
        return false;
    }
    at[0] = (at[0] + 0.5) * scale[0] - 0.5;
    at[1] = (at[1] + 0.5) * scale[1] - 0.5;
    return at[0] >= -0.5 && at[1] >= -0.5 && at[0] < width - 0.5 && at[1] < height - 0.5;
}

int straighten(const lens *l, picture *p, char *error, size_t error_bytes)
{
    const lens bounded = within_fold(l);
    const size_t pixels = (size_t)p->width * p->height, bytes = (size_t)p->channels * (p->bits / 8u);
    picture out = *p;
    size_t seen = 0;
    out.samples = calloc(pixels, bytes);
    out.valid = p->bits == 8 ? calloc(pixels, 1) : NULL;
    if (out.samples == NULL || (p->bits == 8 && out.valid == NULL)) {
        free(out.samples);
        free(out.valid);
        return t3r_reason(error, error_bytes, "out of memory");
    }
    for (size_t i = 0; i < pixels; i++) {
        double at[2];
        if (!source_of(&bounded, p->width, p->height, (uint32_t)(i % p->width), (uint32_t)(i / p->width), at)) {
            continue;
        }
        const size_t nearest = (size_t)floor(at[1] + 0.5) * p->width + (size_t)floor(at[0] + 0.5);
        seen++;
        if (p->bits == 16) {
            ((uint16_t *)out.samples)[i] = ((const uint16_t *)p->samples)[nearest];
        } else if (p->valid == NULL || p->valid[nearest] != 0) {
            out.valid[i] = 1;
            interpolate(p, at[0], at[1], (uint8_t *)out.samples + i * bytes);
        }
    }
    picture_free(p);
    *p = out;
    return 2 * seen >= pixels
               ? 0
               : t3r_reason(error, error_bytes,
                            "distortion: the coefficients fold, or push out of view, more than half of the picture");
}

void straighten_hide(const lens *l, uint32_t width, uint32_t height, uint8_t *depth_z16)
{
    const lens bounded = within_fold(l);
    for (size_t i = 0; i < (size_t)width * height; i++) {
        double at[2];
        if (!source_of(&bounded, width, height, (uint32_t)(i % width), (uint32_t)(i / width), at)) {
            t3r_store_le16(depth_z16 + 2 * i, 0);
        }
    }
}
