/* SPDX-License-Identifier: Apache-2.0 */
/* Analysis by filters straight from their definitions: y[i] = sum over k of filter[k] x[2 i + k + phase], wrapped. */
#include "oracle_analysis.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct filters {
    int length_low, phase_low, length_high, phase_high;
    double low[5], high[5];
} filters;

static filters filters_of(t3r_wavelet kind)
{
    const double r2 = sqrt(2), r3 = sqrt(3);
    if (kind == T3R_WAVELET_HAAR) {
        return (filters){2, 0, 2, 0, {1 / r2, 1 / r2}, {1 / r2, -1 / r2}};
    }
    if (kind == T3R_WAVELET_CDF53) {
        const double a = r2 / 8, b = r2 / 4;
        return (filters){5, -2, 3, 0, {-a, 2 * a, 6 * a, 2 * a, -a}, {-b, 2 * b, -b}};
    }
    /* Daubechies 1992, two vanishing moments; the high pass is the quadrature mirror */
    const double s = 4 * r2, h[4] = {(1 + r3) / s, (3 + r3) / s, (3 - r3) / s, (1 - r3) / s};
    return (filters){4, -1, 4, -1, {h[0], h[1], h[2], h[3]}, {h[3], -h[2], h[1], -h[0]}};
}

static double filtered(const double *line, size_t n, size_t step, const double *filter, int length, long at)
{
    double sum = 0;
    for (int k = 0; k < length; k++) {
        long i = (at + k) % (long)n;
        sum += filter[k] * line[(size_t)(i < 0 ? i + (long)n : i) * step];
    }
    return sum;
}

static void split(double *line, size_t n, size_t step, const filters *f, double *work)
{
    for (size_t i = 0; i < n / 2; i++) {
        work[i] = filtered(line, n, step, f->low, f->length_low, 2 * (long)i + f->phase_low);
        work[n / 2 + i] = filtered(line, n, step, f->high, f->length_high, 2 * (long)i + f->phase_high);
    }
    for (size_t i = 0; i < n; i++) {
        line[i * step] = work[i];
    }
}

void oracle_wavelet(double *plane, size_t width, size_t height, uint32_t levels, t3r_wavelet kind)
{
    filters f = filters_of(kind);
    double *work = malloc((width > height ? width : height) * sizeof *work);
    if (work == NULL) {
        fprintf(stderr, "oracle: out of memory\n");
        exit(EXIT_FAILURE);
    }
    for (uint32_t level = 0; level < levels; level++) {
        size_t w = width >> level, h = height >> level;
        for (size_t y = 0; y < h; y++) {
            split(&plane[y * width], w, 1, &f, work);
        }
        for (size_t x = 0; x < w; x++) {
            split(&plane[x], h, width, &f, work);
        }
    }
    free(work);
}

double oracle_wavelet_energy(const double *plane, size_t width, size_t height, uint32_t levels)
{
    double sum = 0;
    for (uint32_t level = 1; level <= levels; level++) {
        size_t w = width >> level, h = height >> level;
        for (size_t y = 0; y < 2 * h; y++) {
            for (size_t x = 0; x < 2 * w; x++) {
                if (x >= w || y >= h) {
                    sum += fabs(plane[y * width + x]) * pow(4, level);
                }
            }
        }
    }
    return sum;
}
