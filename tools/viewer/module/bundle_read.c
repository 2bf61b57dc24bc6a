/* SPDX-License-Identifier: Apache-2.0 */
#include "module/bundle_read.h"

#include "module/carried.h"

typedef struct reading {
    const uint8_t *start;
    size_t at, count;
    int32_t broken; /* 1 = the bundle ended too early */
} reading;

static const uint8_t *take(reading *in, size_t bytes)
{
    if (bytes > in->count - in->at) {
        in->broken = 1;
        in->at = in->count;
        return in->start;
    }
    const uint8_t *taken = in->start + in->at;
    in->at += bytes;
    return taken;
}

static uint64_t take_number(reading *in, uint32_t bytes)
{
    const uint8_t *from = take(in, bytes);
    uint64_t value = 0;
    for (uint32_t i = 0; i < bytes && !in->broken; i++) {
        value |= (uint64_t)from[i] << (8 * i);
    }
    return value;
}

static uint32_t take_u32(reading *in)
{
    return (uint32_t)take_number(in, 4);
}

static const uint8_t *take_block(reading *in, size_t bytes)
{
    (void)take(in, (BUNDLE_ALIGN - in->at % BUNDLE_ALIGN) % BUNDLE_ALIGN);
    return take(in, bytes);
}

static void take_config(reading *in, t3r_config *config)
{
    uint32_t *words = (uint32_t *)config; /* a struct of 32-bit words: bundle_layout.h */
    in->broken |= take_u32(in) != BUNDLE_CONFIG_WORDS;
    for (uint32_t i = 0; i < BUNDLE_CONFIG_WORDS; i++) {
        words[i] = take_u32(in);
    }
}

static void take_frame(reading *in, frame_data *frame)
{
    t3r_camera *c = &frame->camera;
    *c = (t3r_camera){0};
    c->fx_q16 = (int32_t)take_u32(in);
    c->fy_q16 = (int32_t)take_u32(in);
    c->cx_q16 = (int32_t)take_u32(in);
    c->cy_q16 = (int32_t)take_u32(in);
    for (int i = 0; i < 3; i++) {
        c->position_q32[i] = (int64_t)take_number(in, 8);
    }
    for (int i = 0; i < 4; i++) {
        c->rotation_q30[i] = (int32_t)take_u32(in);
    }
    frame->depth_unit_q40 = take_number(in, 8);
    frame->is_partial = take_u32(in) != 0;
}

static void take_pixels(reading *in, frame_data *frame, size_t pixels)
{
    frame->rgb = take_block(in, pixels * 3);
    frame->depth = frame->depth_unit_q40 != 0 ? take_block(in, pixels * 2) : NULL;
    frame->shown = frame->is_partial ? take_block(in, pixels) : NULL;
}

static bool read_all(reading *in, bundle_data *out)
{
    if (take_u32(in) != BUNDLE_MAGIC) {
        return false;
    }
    take_config(in, &out->config);
    const uint32_t views = take_u32(in);
    out->frames = take_u32(in);
    out->weight_bytes = take_u32(in);
    out->gaussian_count = take_u32(in);
    out->scene_frame.exponent = (int32_t)take_u32(in);
    for (int i = 0; i < 3; i++) {
        out->scene_frame.origin_q32[i] = (int64_t)take_number(in, 8);
    }
    out->traits.degree = take_u32(in);
    out->traits.mip = take_u32(in) != 0;
    out->traits.finer = take_u32(in);
    out->far_count = take_u32(in);
    out->traits.is_spread = out->traits.finer > 0 || out->far_count > 0;
    if (in->broken || out->frames > BUNDLE_MOST_FRAMES || views > out->frames || views != out->config.views ||
        out->gaussian_count > T3R_MAX_GAUSSIANS || out->far_count > out->gaussian_count ||
        out->traits.degree > T3R_HARMONICS_DEGREE_MOST || out->config.width > T3R_MAX_SIDE ||
        out->config.height > T3R_MAX_SIDE) {
        return false;
    }
    for (uint32_t i = 0; i < out->frames; i++) {
        take_frame(in, &out->frame[i]);
    }
    out->weights = take_block(in, out->weight_bytes);
    for (uint32_t i = 0; i < out->frames; i++) {
        take_pixels(in, &out->frame[i], (size_t)out->config.width * out->config.height);
    }
    out->gaussians = take_block(in, (size_t)out->gaussian_count * BUNDLE_GAUSSIAN_BYTES);
    out->far = take_block(in, (size_t)out->far_count * BUNDLE_FAR_BYTES);
    out->harmonics = take_block(in, 2 * (size_t)out->gaussian_count * carried_harmonics_count(out->traits.degree));
    return !in->broken;
}

bool bundle_read(const uint8_t *bytes, size_t count, bundle_data *out)
{
    reading in = {.start = bytes, .count = count};
    return read_all(&in, out);
}

t3r_gaussian bundle_gaussian(const bundle_data *bundle, uint32_t index)
{
    reading in = {.start = bundle->gaussians + (size_t)index * BUNDLE_GAUSSIAN_BYTES, .count = BUNDLE_GAUSSIAN_BYTES};
    t3r_gaussian g = {0};
    for (int i = 0; i < 3; i++) {
        g.position_q20[i] = (int32_t)take_u32(&in);
    }
    for (int i = 0; i < 9; i++) {
        g.factor[i] = (int16_t)take_number(&in, 2);
    }
    g.factor_exponent = (int8_t)take_number(&in, 1);
    g.view = (uint8_t)take_number(&in, 1);
    for (int i = 0; i < 3; i++) {
        g.colour_q7[i] = (uint16_t)take_number(&in, 2);
    }
    g.opacity_q15 = (uint16_t)take_number(&in, 2);
    g.confidence = (uint8_t)take_number(&in, 1);
    return g;
}

double bundle_times(const bundle_data *bundle, uint32_t index)
{
    uint32_t low = 0, high = bundle->far_count;
    while (low < high) { /* by rising index */
        const uint32_t middle = low + (high - low) / 2;
        reading in = {.start = bundle->far + (size_t)middle * BUNDLE_FAR_BYTES, .count = BUNDLE_FAR_BYTES};
        const uint32_t found = take_u32(&in);
        if (found == index) {
            const union {
                uint64_t bits;
                double times;
            } as = {take_number(&in, 8)};
            return as.times;
        }
        low = found < index ? middle + 1 : low;
        high = found < index ? high : middle;
    }
    return 1;
}

const int16_t *bundle_harmonics(const bundle_data *bundle, uint32_t index)
{
    const size_t count = carried_harmonics_count(bundle->traits.degree);
    /* blocks are aligned to 16, and WebAssembly is little-endian */
    return count > 0 ? (const int16_t *)bundle->harmonics + index * count : NULL;
}
