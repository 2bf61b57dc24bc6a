#include "pictures/metrics.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "pictures/metrics_filter.h"

#define WINDOW_RADIUS 5u
#define WINDOW_TAPS (2 * WINDOW_RADIUS + 1)
#define WINDOW_SIGMA 1.5

static bool counts(const uint8_t *mask, size_t pixel)
{
    return mask == NULL || mask[pixel] != 0;
}

static double mean_over_mask(const double *values, const uint8_t *mask, size_t pixels)
{
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (counts(mask, i)) {
            sum += values[i];
            count++;
        }
    }
    return count == 0 ? NAN : sum / (double)count;
}

double metric_psnr(const uint8_t *target, const uint8_t *render, const uint8_t *mask, uint32_t width, uint32_t height)
{
    size_t pixels = (size_t)width * height, count = 0;
    uint64_t sum = 0; /* exact: 4096 x 4096 x 3 x 255^2 < 2^42 */
    for (size_t i = 0; i < pixels; i++) {
        if (!counts(mask, i)) {
            continue;
        }
        for (size_t c = 0; c < 3; c++) {
            int difference = (int)target[3 * i + c] - (int)render[3 * i + c];
            sum += (uint64_t)(difference * difference);
        }
        count++;
    }
    if (count == 0) {
        return NAN;
    }
    return sum == 0 ? 99.0 : 10 * log10(255.0 * 255.0 * 3.0 * (double)count / (double)sum);
}

static void gaussian_window(double taps[WINDOW_TAPS])
{
    double sum = 0;
    for (uint32_t k = 0; k < WINDOW_TAPS; k++) {
        double x = (double)k - WINDOW_RADIUS;
        taps[k] = exp(-x * x / (2 * WINDOW_SIGMA * WINDOW_SIGMA));
        sum += taps[k];
    }
    for (uint32_t k = 0; k < WINDOW_TAPS; k++) {
        taps[k] /= sum;
    }
}

double metric_ssim(const uint8_t *target, const uint8_t *render, const uint8_t *mask, uint32_t width, uint32_t height)
{
    static const double c1 = (0.01 * 255) * (0.01 * 255), c2 = (0.03 * 255) * (0.03 * 255);
    size_t pixels = (size_t)width * height;
    double *planes = malloc(7 * pixels * sizeof *planes);
    if (planes == NULL) {
        return NAN;
    }
    /* windowed means of a, b, a a, b b, a b; then the map and the filter's workspace */
    double *blurred[5], *map = planes + 5 * pixels, *work = planes + 6 * pixels;
    double taps[WINDOW_TAPS];
    gaussian_window(taps);
    for (size_t p = 0; p < 5; p++) {
        blurred[p] = planes + p * pixels;
    }
    for (size_t i = 0; i < pixels; i++) {
        map[i] = 0;
    }
    for (size_t c = 0; c < 3; c++) {
        for (size_t i = 0; i < pixels; i++) {
            double a = target[3 * i + c], b = render[3 * i + c];
            blurred[0][i] = a;
            blurred[1][i] = b;
            blurred[2][i] = a * a;
            blurred[3][i] = b * b;
            blurred[4][i] = a * b;
        }
        for (size_t p = 0; p < 5; p++) {
            metrics_filter(blurred[p], blurred[p], work, width, height, taps, taps, WINDOW_RADIUS,
                           METRICS_BORDER_REFLECT);
        }
        for (size_t i = 0; i < pixels; i++) {
            double ma = blurred[0][i], mb = blurred[1][i];
            double va = blurred[2][i] - ma * ma, vb = blurred[3][i] - mb * mb, cov = blurred[4][i] - ma * mb;
            map[i] += (2 * ma * mb + c1) * (2 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2)) / 3;
        }
    }
    double mean = mean_over_mask(map, mask, pixels);
    free(planes);
    return mean;
}

/* Returns the mean of r, g and b. */
static double grey(const uint8_t *rgb, size_t pixel)
{
    return ((double)rgb[3 * pixel] + rgb[3 * pixel + 1] + rgb[3 * pixel + 2]) / 3;
}

/* Returns the slope as numpy's gradient does: central differences inside, one-sided ones at the edges. */
static double slope(const uint8_t *rgb, size_t base, uint32_t at, uint32_t n, size_t step)
{
    uint32_t before = at > 0 ? at - 1 : at, after = at + 1 < n ? at + 1 : at;
    if (before == after) {
        return 0; /* a line of one sample has no slope */
    }
    return (grey(rgb, base + after * step) - grey(rgb, base + before * step)) / (double)(after - before);
}

static double mean_gradient(const uint8_t *rgb, const uint8_t *mask, uint32_t width, uint32_t height)
{
    double sum = 0;
    size_t count = 0;
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            if (counts(mask, (size_t)y * width + x)) {
                sum += hypot(slope(rgb, (size_t)y * width, x, width, 1), slope(rgb, x, y, height, width));
                count++;
            }
        }
    }
    return count == 0 ? NAN : sum / (double)count;
}

double metric_sharp(const uint8_t *target, const uint8_t *render, const uint8_t *mask, uint32_t width, uint32_t height)
{
    double reference = mean_gradient(target, mask, width, height);
    return mean_gradient(render, mask, width, height) / (reference < 1e-9 ? 1e-9 : reference);
}
