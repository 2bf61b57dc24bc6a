/* SPDX-License-Identifier: Apache-2.0 */
#include "module/sketch.h"

#include "core/fixed.h"
#include "core/memory.h"
#include "raster/raster_splat.h"

#define WIDEST 8.0 /* times the Gaussian's own width, so that needles do not become spikes */

size_t sketch_bytes(uint32_t gaussians)
{
    return T3R_SORT_BYTES + (size_t)gaussians * 4 * sizeof(uint32_t);
}

void sketch_init(sketch *s, void *memory, uint32_t gaussians)
{
    uint32_t *at = memory;
    *s = (sketch){.histogram = at};
    at += T3R_SORT_BYTES / sizeof *at;
    for (int side = 0; side < 2; side++) {
        s->keys[side] = at;
        s->indices[side] = at + gaussians;
        at += 2 * (size_t)gaussians;
    }
}

static double power_of_two(int exponent)
{
    const uint64_t bits = (uint64_t)(1023 + exponent) << 52; /* of a double without a fraction */
    double power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

/* Returns opacity times the root of the sum of the squared 2 x 2 minors of the factor: about pi times smaller than the
 * area of the Gaussian's ellipsoid seen along its shortest axis. */
static double weight_of(const t3r_gaussian *g)
{
    double sum = 0;
    for (int row = 0; row < 3; row++) {
        const int16_t *a = g->factor + 3 * row, *b = g->factor + 3 * ((row + 1) % 3);
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3;
            const double minor = (double)a[i] * b[j] - (double)a[j] * b[i];
            sum += minor * minor;
        }
    }
    return g->opacity_q15 * __builtin_sqrt(sum) * power_of_two(2 * g->factor_exponent);
}

/* Keys are the bits of the priorities as floats, which are ordered as these are; complemented, the largest comes
 * first. */
static uint32_t key_of(double priority)
{
    const float value = (float)priority;
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return ~bits;
}

static double priority_of(uint32_t key)
{
    const uint32_t bits = ~key;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

void sketch_begin(sketch *s)
{
    s->count = s->side = 0;
}

void sketch_weigh(sketch *s, uint32_t index, const t3r_gaussian *gaussian)
{
    /* multiples of the golden section, modulo 1: neighbours in a file get evenly spread numbers in (0, 1] */
    const double spread = ((index + 1) * 2654435769u + 1.0) / 4294967296.0;
    s->keys[0][s->count] = key_of(weight_of(gaussian) / spread);
    s->indices[0][s->count++] = index;
}

void sketch_arrange(sketch *s, const t3r_kernels *kernels)
{
    s->side = t3r_order(kernels, s->keys, s->indices, s->count, s->histogram);
}

uint32_t sketch_index(const sketch *s, uint32_t rank)
{
    return s->indices[s->side][rank];
}

static void enlarge(t3r_gaussian *g, double times)
{
    int shift = 0;
    for (; times > 1; shift++) {
        times /= 2;
    }
    for (int i = 0; i < 9; i++) {
        g->factor[i] = (int16_t)(g->factor[i] * times); /* times is at most 1 */
    }
    g->factor_exponent = (int8_t)T3R_MIN(g->factor_exponent + shift, 15);
}

void sketch_widen(const sketch *s, uint32_t drawn, t3r_gaussian *gaussian)
{
    const double weight = weight_of(gaussian), threshold = priority_of(s->keys[s->side][drawn]);
    if (!(weight > 0) || weight >= threshold) {
        return;
    }
    const double times = __builtin_sqrt(threshold / weight);
    enlarge(gaussian, times < WIDEST ? times : WIDEST);
}
