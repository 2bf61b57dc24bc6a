/* SPDX-License-Identifier: Apache-2.0 */
#include <math.h>
#include <stdlib.h>

#include "study/stress/perturbation.h"
#include "study/stress/random.h"

#define GAMMA 2.2
#define BLUR_REACH 3 /* deviations */

static uint8_t level(double x)
{
    return (uint8_t)(x <= 0 ? 0 : x >= 255 ? 255 : floor(x + 0.5));
}

bool perturb_noise(stress_capture *capture, double levels, uint32_t seed)
{
    size_t samples = (size_t)capture->width * capture->height * 3;
    for (uint32_t v = 0; v < capture->views; v++) {
        uint32_t view_seed = stress_random(seed, v);
        for (size_t i = 0; i < samples; i++) {
            uint8_t *sample = &capture->view[v].rgb[i];
            *sample = level(*sample + levels * stress_normal(view_seed, (uint32_t)i));
        }
    }
    return true;
}

/* Blurs `count` samples `step` apart, borders repeated. */
static void blur_line(const double *weight, int reach, const double *from, double *to, int count, size_t step)
{
    for (int i = 0; i < count; i++) {
        double sum = 0;
        for (int k = -reach; k <= reach; k++) {
            int at = i + k < 0 ? 0 : i + k >= count ? count - 1 : i + k;
            sum += weight[abs(k)] * from[(size_t)at * step];
        }
        to[(size_t)i * step] = sum;
    }
}

static void blur_picture(const double *weight, int reach, uint8_t *rgb, uint32_t width, uint32_t height, double *a,
                         double *b)
{
    size_t samples = (size_t)width * height * 3;
    for (size_t i = 0; i < samples; i++) {
        a[i] = rgb[i];
    }
    for (size_t line = 0; line < (size_t)height * 3; line++) {
        size_t start = line / 3 * width * 3 + line % 3;
        blur_line(weight, reach, a + start, b + start, (int)width, 3);
    }
    for (size_t column = 0; column < (size_t)width * 3; column++) {
        blur_line(weight, reach, b + column, a + column, (int)height, (size_t)width * 3);
    }
    for (size_t i = 0; i < samples; i++) {
        rgb[i] = level(a[i]);
    }
}

bool perturb_blur(stress_capture *capture, double pixels, uint32_t seed)
{
    (void)seed;
    if (!(pixels > 0)) {
        return true;
    }
    int reach = (int)ceil(BLUR_REACH * pixels);
    size_t samples = (size_t)capture->width * capture->height * 3;
    double *weight = malloc(((size_t)reach + 1) * sizeof *weight);
    double *a = malloc(samples * sizeof *a), *b = malloc(samples * sizeof *b);
    bool done = weight != NULL && a != NULL && b != NULL;
    double sum = 0;
    for (int k = 0; k <= reach && done; k++) {
        weight[k] = exp(-0.5 * k * k / (pixels * pixels));
        sum += k == 0 ? weight[k] : 2 * weight[k];
    }
    for (int k = 0; k <= reach && done; k++) {
        weight[k] /= sum;
    }
    for (uint32_t v = 0; v < capture->views && done; v++) {
        blur_picture(weight, reach, capture->view[v].rgb, capture->width, capture->height, a, b);
    }
    free(weight);
    free(a);
    free(b);
    return done;
}

/* Applies stops[c], up in even views, down in odd ones. */
static void gains(stress_capture *capture, const double stops[3])
{
    size_t pixels = (size_t)capture->width * capture->height;
    for (uint32_t v = 0; v < capture->views; v++) {
        double gain[3];
        for (int c = 0; c < 3; c++) {
            gain[c] = exp2((v % 2 == 0 ? stops[c] : -stops[c]) / GAMMA);
        }
        for (size_t i = 0; i < pixels * 3; i++) {
            capture->view[v].rgb[i] = level(capture->view[v].rgb[i] * gain[i % 3]);
        }
    }
}

bool perturb_exposure(stress_capture *capture, double stops, uint32_t seed)
{
    (void)seed;
    gains(capture, (const double[3]){stops / 2, stops / 2, stops / 2});
    return true;
}

bool perturb_white(stress_capture *capture, double stops, uint32_t seed)
{
    (void)seed;
    gains(capture, (const double[3]){stops / 2, 0, -stops / 2});
    return true;
}
