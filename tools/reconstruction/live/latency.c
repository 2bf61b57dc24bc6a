/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/live/latency.h"

#include <math.h>
#include <stdio.h>

enum { BINS = LATENCY_OCTAVES * LATENCY_FINE };

void latency_add(latency *times, double milliseconds)
{
    const double at = log2(fmax(milliseconds * 1000, 1)) * LATENCY_FINE;
    times->bins[at < BINS ? (uint32_t)at : BINS - 1]++;
    times->count++;
    times->sum += milliseconds;
    times->worst = fmax(times->worst, milliseconds);
}

double latency_mean(const latency *times)
{
    return times->count > 0 ? times->sum / (double)times->count : 0;
}

double latency_of_share(const latency *times, uint32_t percent)
{
    uint64_t seen = 0;
    uint32_t bin = 0;
    while (bin < BINS - 1 && 100 * (seen + times->bins[bin]) < percent * times->count) {
        seen += times->bins[bin++];
    }
    return fmin(exp2((bin + 0.5) / LATENCY_FINE) / 1000, times->worst);
}

double latency_rate(const latency *times)
{
    return times->sum > 0 ? 1000 * (double)times->count / times->sum : 0;
}

const char *latency_text(const latency *times, char text[LATENCY_TEXT_BYTES])
{
    snprintf(text, LATENCY_TEXT_BYTES, "median %.2f ms, 95 %% at most %.2f ms, worst %.2f ms",
             latency_of_share(times, 50), latency_of_share(times, 95), times->worst);
    return text;
}
