/* SPDX-License-Identifier: Apache-2.0 */
/* SSIM: Wang et al. 2004, with a Gaussian window of 11 x 11, sigma 1.5, zeros beyond the border, each channel
 * separately, as in 3D Gaussian Splatting. */
#include "study/rivals/tuning/photometric.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "study/rivals/splats/vectorized.h"

enum { REACH = 5, TAPS = 2 * REACH + 1 };
enum { PICTURE, MEAN, SQUARE, OF_TARGET };
enum { OWN, OWN_MEAN, OWN_SQUARE, PRODUCT, SCRATCH, WORK };

#define SIGMA 1.5
#define C1 1e-4f /* (0.01)^2 */
#define C2 9e-4f /* (0.03)^2 */

static float *plane(const photometric *p, int index)
{
    return p->planes + (size_t)index * p->width * p->height;
}

static float *of_target(const photometric *p, int channel, int which)
{
    return plane(p, channel * OF_TARGET + which);
}

static float *work(const photometric *p, int which)
{
    return plane(p, 3 * OF_TARGET + which);
}

static void window(float taps[TAPS])
{
    double sum = 0, exact[TAPS];
    for (int i = 0; i < TAPS; i++) {
        exact[i] = exp(-(i - REACH) * (i - REACH) / (2 * SIGMA * SIGMA));
        sum += exact[i];
    }
    for (int i = 0; i < TAPS; i++) {
        taps[i] = (float)(exact[i] / sum);
    }
}

/* Adds weight x from[] shifted by `shift` to line[], zeros beyond the border. */
RIVAL_INLINE void add_shifted(float *restrict line, const float *restrict from, ptrdiff_t shift, ptrdiff_t count,
                              float weight)
{
    ptrdiff_t first = shift < 0 ? -shift : 0, last = shift > 0 ? count - shift : count;
    for (ptrdiff_t i = first; i < last; i++) {
        line[i] += weight * from[i + shift];
    }
}

/* Replaces a plane by its Gaussian mean; the operation is its own transpose. */
RIVAL_VARIANTS static void blur(const photometric *p, float *values)
{
    float taps[TAPS], *across = work(p, SCRATCH);
    ptrdiff_t width = p->width, height = p->height;
    size_t bytes = (size_t)width * (size_t)height * sizeof(float);
    window(taps);
    memset(across, 0, bytes);
    for (ptrdiff_t y = 0; y < height; y++) {
        for (ptrdiff_t i = -REACH; i <= REACH; i++) {
            add_shifted(across + y * width, values + y * width, i, width, taps[i + REACH]);
        }
    }
    memset(values, 0, bytes);
    for (ptrdiff_t y = 0; y < height; y++) {
        for (ptrdiff_t i = -REACH; i <= REACH; i++) {
            if (y + i >= 0 && y + i < height) {
                add_shifted(values + y * width, across + (y + i) * width, 0, width, taps[i + REACH]);
            }
        }
    }
}

bool photometric_open(photometric *p, const uint8_t *rgb, uint32_t width, uint32_t height)
{
    size_t pixels = (size_t)width * height;
    *p = (photometric){.width = width, .height = height};
    p->planes = malloc(pixels * (3 * OF_TARGET + WORK) * sizeof *p->planes);
    if (p->planes == NULL) {
        return false;
    }
    for (int c = 0; c < 3; c++) {
        float *picture = of_target(p, c, PICTURE), *mean = of_target(p, c, MEAN), *square = of_target(p, c, SQUARE);
        for (size_t i = 0; i < pixels; i++) {
            picture[i] = mean[i] = (float)rgb[i * 3 + (size_t)c] / 255;
            square[i] = picture[i] * picture[i];
        }
        blur(p, mean);
        blur(p, square);
    }
    return true;
}

void photometric_close(photometric *p)
{
    free(p->planes);
    *p = (photometric){0};
}

/* Returns the similarity at a pixel and replaces the means of the picture, of its square and of its product with the
 * target by the derivatives of the similarity with respect to these means. */
RIVAL_INLINE float differentiate(float *mean, float *square, float *product, float target_mean, float target_square)
{
    float a1 = 2 * *mean * target_mean + C1, a2 = 2 * (*product - *mean * target_mean) + C2;
    float b1 = *mean * *mean + target_mean * target_mean + C1;
    float b2 = *square - *mean * *mean + target_square - target_mean * target_mean + C2;
    float s = a1 * a2 / (b1 * b2), by_a1 = a2 / (b1 * b2), by_a2 = a1 / (b1 * b2);
    *mean = 2 * target_mean * (by_a1 - by_a2) - 2 * *mean * (s / b1 - s / b2);
    *square = -s / b2;
    *product = 2 * by_a2;
    return s;
}

/* Adds one channel's share to gradient[]; returns its mean similarity. */
RIVAL_VARIANTS static double add_channel(const photometric *p, int channel, double share, const float *rgb,
                                         float *gradient)
{
    size_t pixels = (size_t)p->width * p->height;
    const float *target = of_target(p, channel, PICTURE);
    float *own = work(p, OWN), *mean = work(p, OWN_MEAN), *square = work(p, OWN_SQUARE), *product = work(p, PRODUCT);
    for (size_t i = 0; i < pixels; i++) {
        own[i] = mean[i] = rgb[i * 3 + (size_t)channel];
        square[i] = own[i] * own[i];
        product[i] = own[i] * target[i];
    }
    blur(p, mean);
    blur(p, square);
    blur(p, product);
    double sum = 0;
    for (size_t i = 0; i < pixels; i++) {
        sum += (double)differentiate(&mean[i], &square[i], &product[i], of_target(p, channel, MEAN)[i],
                                     of_target(p, channel, SQUARE)[i]);
    }
    blur(p, mean);
    blur(p, square);
    blur(p, product);
    float scale = (float)(share / (3.0 * (double)pixels));
    for (size_t i = 0; i < pixels; i++) {
        gradient[i * 3 + (size_t)channel] -= scale * (mean[i] + 2 * own[i] * square[i] + target[i] * product[i]);
    }
    return sum / (double)pixels;
}

double photometric_loss(const photometric *p, double similarity, const float *rgb, float *gradient)
{
    size_t pixels = (size_t)p->width * p->height;
    float step = (float)((1 - similarity) / (3.0 * (double)pixels));
    double difference = 0, dissimilarity = 0;
    for (size_t i = 0; i < pixels * 3; i++) {
        float d = rgb[i] - of_target(p, (int)(i % 3), PICTURE)[i / 3];
        difference += fabs((double)d);
        gradient[i] = d > 0 ? step : d < 0 ? -step : 0;
    }
    for (int c = 0; c < 3 && similarity > 0; c++) {
        dissimilarity += (1 - add_channel(p, c, similarity, rgb, gradient)) / 3;
    }
    return (1 - similarity) * difference / (3.0 * (double)pixels) + similarity * dissimilarity;
}
