#include "pictures/metrics_filter.h"

#include <stddef.h>

/* Returns the index of sample `i` of a line of n samples under the border rule. */
static size_t border_index(int64_t i, int64_t n, metrics_border border)
{
    if (border == METRICS_BORDER_REPLICATE) {
        return (size_t)(i < 0 ? 0 : i >= n ? n - 1 : i);
    }
    int64_t period = 2 * n;
    int64_t at = i % period;
    at = at < 0 ? at + period : at;
    return (size_t)(at < n ? at : period - 1 - at);
}

static void filter_row(const double *in, double *out, uint32_t width, const double *taps, uint32_t radius,
                       metrics_border border)
{
    for (uint32_t x = 0; x < width; x++) {
        double sum = 0;
        if (x >= radius && x + radius < width) {
            const double *from = in + (x - radius);
            for (uint32_t k = 0; k <= 2 * radius; k++) {
                sum += taps[k] * from[k];
            }
        } else {
            for (uint32_t k = 0; k <= 2 * radius; k++) {
                sum += taps[k] * in[border_index((int64_t)x + k - radius, width, border)];
            }
        }
        out[x] = sum;
    }
}

void metrics_filter(const double *in, double *out, double *work, uint32_t width, uint32_t height, const double *across,
                    const double *down, uint32_t radius, metrics_border border)
{
    for (uint32_t y = 0; y < height; y++) {
        filter_row(in + (size_t)y * width, work + (size_t)y * width, width, across, radius, border);
    }
    for (uint32_t y = 0; y < height; y++) {
        double *row = out + (size_t)y * width;
        for (uint32_t x = 0; x < width; x++) {
            row[x] = 0;
        }
        for (uint32_t k = 0; k <= 2 * radius; k++) {
            const double *from = work + border_index((int64_t)y + k - radius, height, border) * width;
            double tap = down[k];
            for (uint32_t x = 0; x < width; x++) {
                row[x] += tap * from[x];
            }
        }
    }
}
