/* SPDX-License-Identifier: Apache-2.0 */
/* A block of pixels through a layer, against sums in 64 bits and the rounding of SPEC.md, in integers. */
#include "checks.h"
#include "guarded.h"

enum { TAPS = 330, OUTPUTS = 60 };

static uint32_t bits_of(uint64_t *seed)
{
    return unit_random(seed) % 2 ? 8 : 16;
}

static int64_t extreme(uint64_t *seed, uint32_t bits)
{
    const int64_t most = (int64_t)1 << (bits - 1);
    return any_value(seed, -most, most - 1);
}

static void put(uint8_t *to, int64_t x, uint32_t bytes)
{
    for (uint32_t i = 0; i < bytes; i++) {
        to[i] = (uint8_t)((uint64_t)x >> (8 * i));
    }
}

static int64_t get(const uint8_t *from, uint32_t bytes)
{
    uint64_t x = 0;
    for (uint32_t i = 0; i < bytes; i++) {
        x |= (uint64_t)from[i] << (8 * i);
    }
    const uint32_t unused = 64 - 8 * bytes;
    return (int64_t)(x << unused) >> unused;
}

static int64_t requantized(int64_t acc, const t3r_convolution *l, uint32_t output)
{
    int64_t multiplier = get(l->multiplier + 4 * output, 4), shift = 31 - get(l->shift + output, 1);
    if (l->activation_bits == 16) {
        multiplier = (multiplier + 32768) >> 16;
        multiplier = multiplier > 32767 ? 32767 : multiplier;
        shift -= 16;
    }
    const int64_t scaled = (acc * multiplier + ((int64_t)1 << (shift - 1))) >> shift;
    const int64_t most = ((int64_t)1 << (l->output_bits - 1)) - 1;
    const int64_t sum = l->zero + scaled;
    return sum < -most - 1 ? -most - 1 : sum > most ? most : sum;
}

/* The kind of kernel that runs a layer. */
typedef enum layer_kind { CONVOLVE, DEPTHWISE, PACKED } layer_kind;

/* Makes a block of `places` activations a pixel: columns, or strips in `rows` runs. */
static t3r_block make_block(layer_kind kind, uint32_t places, uint32_t rows, uint64_t *seed)
{
    if (kind == PACKED) {
        const uint32_t step = (uint32_t)unit_between(seed, 1, 70), pixels = (uint32_t)unit_between(seed, 1, 40);
        return (t3r_block){.rows = rows,
                           .run = places / rows,
                           .pitch = (pixels - 1) * step + places / rows + (uint32_t)unit_between(seed, 0, 5),
                           .step = step,
                           .pixels = pixels};
    }
    const uint32_t whole = (places + T3R_COLUMN_TAPS - 1) / T3R_COLUMN_TAPS * T3R_COLUMN_TAPS;
    return (t3r_block){.rows = 1,
                       .run = places,
                       .step = whole + T3R_COLUMN_TAPS * (uint32_t)unit_between(seed, 0, 1),
                       .pixels = (uint32_t)unit_between(seed, 1, T3R_BLOCK_PIXELS)};
}

/* Returns an activation as convolve_packed reads it. */
static int64_t strip_of(int64_t x, uint32_t strip_bytes)
{
    return strip_bytes == 1 ? x + 128 : x;
}

static void fill_block(layer_kind kind, t3r_block *block, uint32_t activation_bits, bool is_large, uint32_t strip_bytes,
                       uint64_t *seed)
{
    const uint32_t bytes = kind == PACKED ? strip_bytes : 2;
    const uint32_t pixels_end = (block->pixels - 1) * block->step + (kind == PACKED ? block->run : block->step);
    const uint32_t end =
        (block->rows - 1) * block->pitch + pixels_end + (kind == PACKED ? (uint32_t)T3R_STRIP_BEHIND : 0);
    uint8_t *x = guarded_take((size_t)end * bytes, kind == PACKED ? bytes : 16);
    for (uint32_t t = 0; t < end; t++) {
        int64_t value = is_large ? -((int64_t)1 << (activation_bits - 1)) : extreme(seed, activation_bits);
        value = kind != PACKED && t % block->step >= block->run ? 0 : value;
        put(x + t * bytes, kind == PACKED ? strip_of(value, bytes) : value, bytes);
    }
    block->x = x;
}

/* The activation at a place under the kernel of pixel i. */
static int64_t activation_at(layer_kind kind, const t3r_block *block, uint32_t i, uint32_t place, uint32_t strip_bytes)
{
    const size_t at = (size_t)(place / block->run) * block->pitch + (size_t)i * block->step + place % block->run;
    if (kind == PACKED && strip_bytes == 1) {
        return ((const uint8_t *)block->x)[at] - 128;
    }
    return get((const uint8_t *)block->x + at * 2, 2);
}

static void run(const t3r_kernels *kernels, layer_kind kind, const t3r_convolution *l, const t3r_block *block,
                void *out, uint32_t out_pitch)
{
    if (kind == PACKED) {
        uint8_t *packed = guarded_take(t3r_packed_bytes(block->rows, block->run, l->outputs), T3R_PACKED_ALIGN);
        kernels->pack_layer(l, block->rows, packed);
        kernels->convolve_packed(l, packed, block, out, out_pitch);
    } else if (kind == DEPTHWISE) {
        kernels->depthwise(l, block, out, out_pitch);
    } else {
        kernels->convolve(l, block, out, out_pitch);
    }
}

static const char *check_layer(const t3r_kernels *kernels, uint64_t *seed, layer_kind kind)
{
    const bool depthwise = kind == DEPTHWISE;
    t3r_convolution l = {.weight_bits = (uint8_t)(kind == PACKED ? 8 : bits_of(seed)),
                         .activation_bits = (uint8_t)(kind == PACKED ? 8 : bits_of(seed))};
    l.output_bits = (uint8_t)(l.activation_bits == 16 ? 16 : bits_of(seed));
    l.outputs = (uint32_t)unit_between(seed, 1, OUTPUTS);
    l.taps =
        (uint32_t)(depthwise ? unit_between(seed, 1, 25) : unit_between(seed, 1, unit_random(seed) % 2 ? 40 : TAPS));
    l.zero = (int16_t)extreme(seed, l.output_bits);
    const uint32_t rows = kind == PACKED ? (uint32_t)unit_between(seed, 1, T3R_LAYER_RUNS) : 1;
    l.taps = (l.taps + rows - 1) / rows * rows;
    const uint32_t weight_bytes = l.weight_bits / 8, wide = l.activation_bits == 16;
    const uint32_t places = l.taps * (depthwise ? l.outputs : 1);
    t3r_block block = make_block(kind, places, rows, seed);
    const uint32_t pixels = block.pixels;
    const uint32_t behind = unit_random(seed) % 2 ? (uint32_t)unit_between(seed, 0, 40) : 0;
    /* products sum to less than 2^31 in any order, or 2^47: the weights' sizes are bounded together */
    const int64_t most_sum = wide ? (int64_t)1 << 31 : (int64_t)1 << 23;
    uint8_t *weights = guarded_take((size_t)l.taps * l.outputs * weight_bytes + behind, weight_bytes);
    uint8_t *bias = guarded_take((size_t)l.outputs * (wide ? 8 : 4), 4), *shift = guarded_take(l.outputs, 1);
    uint8_t *multiplier = guarded_take((size_t)l.outputs * 4, 4);
    l.readable = l.taps * l.outputs * weight_bytes + behind;
    const bool is_large = unit_random(seed) % 3 == 0; /* every weight as large as possible, of one sign */
    for (uint32_t o = 0; o < l.outputs; o++) {
        int64_t sum = 0;
        for (uint32_t t = 0; t < l.taps; t++) {
            int64_t w = is_large ? -((int64_t)1 << (l.weight_bits - 1)) + 1 : extreme(seed, l.weight_bits);
            w = sum + llabs(w) < most_sum ? w : 0;
            sum += llabs(w);
            const size_t at = depthwise ? (size_t)t * l.outputs + o : (size_t)o * l.taps + t;
            put(weights + at * weight_bytes, w, weight_bytes);
        }
        const int64_t rest = (wide ? ((int64_t)1 << 47) - (sum << 15) : ((int64_t)1 << 31) - (sum << 7)) - 1;
        put(bias + (size_t)o * (wide ? 8 : 4), any_value(seed, -rest, rest), wide ? 8 : 4);
        put(multiplier + (size_t)o * 4, any_value(seed, 1 << 30, INT32_MAX), 4);
        put(shift + o, wide ? any_value(seed, -30, 13) : any_value(seed, -30, 15), 1);
    }
    l.weights = weights;
    l.bias = bias;
    l.multiplier = multiplier;
    l.shift = shift;
    fill_block(kind, &block, l.activation_bits, is_large, kernels->strip_bytes, seed);
    const uint32_t out_pitch = l.outputs + (uint32_t)unit_between(seed, 0, 3);
    const uint32_t out_bytes = l.output_bits / 8;
    uint8_t *out = guarded_take(((size_t)(pixels - 1) * out_pitch + l.outputs) * out_bytes, out_bytes);
    run(kernels, kind, &l, &block, out, out_pitch);
    for (uint32_t i = 0; i < pixels; i++) {
        for (uint32_t o = 0; o < l.outputs; o++) {
            int64_t acc = get(bias + (size_t)o * (wide ? 8 : 4), wide ? 8 : 4);
            for (uint32_t t = 0; t < l.taps; t++) {
                const size_t at = depthwise ? (size_t)t * l.outputs + o : (size_t)o * l.taps + t;
                acc += get(weights + at * weight_bytes, weight_bytes) *
                       activation_at(kind, &block, i, (uint32_t)(depthwise ? at : t), kernels->strip_bytes);
            }
            int16_t got;
            const uint8_t *at = out + ((size_t)i * out_pitch + o) * out_bytes;
            memcpy(&got, at, out_bytes);
            if ((out_bytes == 1 ? (int8_t)*at : got) != requantized(acc, &l, o)) {
                return "an activation differs";
            }
        }
    }
    return NULL;
}

const char *check_convolve(const t3r_kernels *kernels, uint64_t *seed)
{
    return check_layer(kernels, seed, CONVOLVE);
}

const char *check_depthwise(const t3r_kernels *kernels, uint64_t *seed)
{
    return check_layer(kernels, seed, DEPTHWISE);
}

/* Plain C has no packed kernels. */
const char *check_convolve_packed(const t3r_kernels *kernels, uint64_t *seed)
{
    return kernels->convolve_packed == NULL ? NULL : check_layer(kernels, seed, PACKED);
}
