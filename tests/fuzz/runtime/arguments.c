/* SPDX-License-Identifier: Apache-2.0 */
#include "arguments.h"

#include <stdlib.h>
#include <string.h>

uint8_t take8(input *in)
{
    if (in->left == 0) {
        return 0;
    }
    in->left--;
    return *in->bytes++;
}

uint32_t take32(input *in)
{
    uint32_t x = 0;
    for (int i = 0; i < 4; i++) {
        x = x << 8 | take8(in);
    }
    return x;
}

uint32_t below(input *in, uint32_t bound)
{
    if (bound == 0) {
        return take32(in);
    }
    uint32_t x = take8(in);
    return (bound > 256 ? x << 8 | take8(in) : x) % bound;
}

uint32_t take_side(input *in)
{
    static const uint32_t wild[] = {0, 1, T3R_MAX_SIDE + 1, UINT32_MAX};
    uint32_t x = take8(in);
    return x < 252 ? 2 + x % (MOST_SIDE + 8) : wild[x - 252];
}

#define LOW(name, kind, low, ...) .name = (low),
#define HIGH(name, kind, low, high, ...) .name = (high),

t3r_config most_settings(void)
{
    return (t3r_config){T3R_SETTINGS(HIGH)};
}

static uint32_t setting_of(const t3r_config *config, size_t at)
{
    uint32_t value;
    memcpy(&value, (const uint8_t *)config + at * sizeof value, sizeof value);
    return value;
}

void take_settings(input *in, size_t first, const t3r_config *most, t3r_config *config)
{
    static const t3r_config least = {T3R_SETTINGS(LOW)};
    for (size_t i = first; i < sizeof *config / sizeof(uint32_t); i++) {
        const uint32_t low = setting_of(&least, i), high = setting_of(most, i);
        const uint32_t value = high > low ? low + below(in, high - low + 1) : low;
        memcpy((uint8_t *)config + i * sizeof value, &value, sizeof value);
    }
}

void *allocate(size_t bytes)
{
    void *p = calloc(1, bytes == 0 ? 1 : bytes);
    REQUIRE(p != NULL);
    return p;
}

void require_status(t3r_status status)
{
    REQUIRE((int)status <= T3R_OK && (int)status >= T3R_ERR_INTERFACE);
    REQUIRE(t3r_error_text(status)[0] != '\0');
}

t3r_camera take_camera(input *in)
{
    uint32_t kind = take8(in);
    t3r_camera c = {
        .fx_q16 = (int32_t)((8 + below(in, 120)) << 16),
        .fy_q16 = (int32_t)((8 + below(in, 120)) << 16),
        .cx_q16 = (int32_t)((below(in, MOST_SIDE)) << 16),
        .cy_q16 = (int32_t)((below(in, MOST_SIDE)) << 16),
        .rotation_q30 = {1 << 30, 0, 0, 0},
    };
    if (kind & 1) {
        for (int i = 0; i < 4; i++) {
            c.rotation_q30[i] = (int32_t)take32(in);
        }
    }
    if (kind & 2) {
        c.distortion = (t3r_distortion)below(in, T3R_DISTORTION_COUNT + 1);
        for (int i = 0; i < 5; i++) {
            c.distortion_q24[i] = (int32_t)take32(in);
        }
    }
    if (kind & 4) {
        for (int i = 0; i < 3; i++) {
            c.position_q32[i] = (int64_t)((uint64_t)take32(in) << 32 | take32(in)) >> (kind & 8 ? 32 : 0);
        }
    }
    if (kind & 16) {
        c.fx_q16 = (int32_t)take32(in);
        c.fy_q16 = (int32_t)take32(in);
        c.cx_q16 = (int32_t)take32(in);
        c.cy_q16 = (int32_t)take32(in);
    }
    if (kind & 32) {
        c.width = below(in, MOST_SIDE);
        c.height = below(in, MOST_SIDE);
    }
    return c;
}

uint64_t plane_bytes(const t3r_frame *f, int plane, uint32_t *row)
{
    uint64_t rows = plane == 0 ? f->height : f->height / 2;
    *row = f->width;
    if (f->format == T3R_PIXEL_RGB24 || f->format == T3R_PIXEL_BGR24) {
        *row = f->width * 3;
    } else if (f->format == T3R_PIXEL_YUYV || f->format == T3R_PIXEL_UYVY) {
        *row = f->width * 2;
    }
    return rows == 0 ? 0 : (rows - 1) * f->stride_bytes[plane] + *row;
}

static uint8_t *take_plane(input *in, size_t bytes)
{
    uint8_t *p = allocate(bytes);
    uint32_t base = take8(in), slope = take8(in), noise = take8(in), x = base + 1;
    for (size_t i = 0; i < bytes; i++) {
        x = x * 1664525u + 1013904223u;
        p[i] = (uint8_t)(base + slope * i / 16 + (noise == 0 ? 0 : (x >> 24) % noise));
    }
    for (uint32_t n = below(in, 8); n > 0 && bytes > 0; n--) {
        p[take32(in) % bytes] = take8(in);
    }
    return p;
}

/* Planes are allocated to the byte, so that a read beyond width, height and stride is caught. */
held_frame take_frame(input *in)
{
    held_frame held = {0};
    t3r_frame *f = &held.frame;
    uint32_t kind = take8(in);
    f->format = (t3r_pixel_format)(kind % (T3R_PIXEL_FORMAT_COUNT + 1));
    f->width = take_side(in);
    f->height = take_side(in);
    const int small = f->width > 0 && f->width <= 2 * MOST_SIDE && f->height <= 2 * MOST_SIDE;
    for (int plane = 0; plane < 2; plane++) {
        uint32_t row = 0;
        (void)plane_bytes(f, plane, &row);
        f->stride_bytes[plane] = row + below(in, 5);
        if (take8(in) == 255 && row > 0) {
            f->stride_bytes[plane] = row - 1; /* refused */
        }
        size_t bytes = small ? (size_t)plane_bytes(f, plane, &row) : 16;
        held.planes[plane] = plane == 0 || f->format == T3R_PIXEL_NV12 ? take_plane(in, bytes) : NULL;
        f->planes[plane] = held.planes[plane];
    }
    if (kind & 64) {
        f->depth_width = take_side(in);
        f->depth_height = take_side(in);
        f->depth_stride_bytes = f->depth_width * 2 + below(in, 5);
        const int fits = f->depth_width <= 2 * MOST_SIDE && f->depth_height <= 2 * MOST_SIDE && f->depth_height > 0;
        size_t bytes = fits ? (size_t)(f->depth_height - 1) * f->depth_stride_bytes + (size_t)f->depth_width * 2 : 16;
        held.planes[2] = take_plane(in, bytes);
        f->depth = held.planes[2];
        f->depth_unit_q40 = kind & 128 ? (uint64_t)take32(in) << (take8(in) % 33) : 1099511628;
    }
    return held;
}

void free_frame(held_frame *held)
{
    for (int i = 0; i < 3; i++) {
        free(held->planes[i]);
    }
}

t3r_gaussian take_gaussian(input *in)
{
    uint32_t kind = take8(in);
    t3r_gaussian g = {.opacity_q15 = (uint16_t)(take32(in) & 0x7fff), .confidence = 255};
    for (int i = 0; i < 3; i++) {
        g.position_q20[i] = kind & 1 ? (int32_t)take32(in) : (int32_t)(take8(in) << 13) - (i < 2 ? 1 << 20 : 0);
        g.colour_q7[i] = (uint16_t)(take8(in) * 128);
    }
    g.factor_exponent = kind & 2 ? (int8_t)take8(in) : (int8_t)(-(int)below(in, 30));
    for (int i = 0; i < 9; i++) {
        g.factor[i] = (int16_t)(kind & 4 ? take32(in) : take8(in));
    }
    if (kind & 8) {
        g.opacity_q15 = (uint16_t)take32(in);
        g.colour_q7[kind % 3] = (uint16_t)take32(in);
        g.reserved[kind % 3] = take8(in);
        g.view = take8(in);
    }
    return g;
}

uint8_t *allocate_arena(size_t bytes)
{
    void *p = NULL;
    REQUIRE(posix_memalign(&p, T3R_ARENA_ALIGN, bytes == 0 ? 1 : bytes) == 0);
    memset(p, 0xc3, bytes);
    return p;
}

picture picture_of(uint32_t width, uint32_t height, uint32_t padding)
{
    picture p = {.target = {.width = width,
                            .height = height,
                            .rgb_stride_bytes = width * 3 + padding,
                            .depth_stride_bytes = width * 4 + padding * 4,
                            .alpha_stride_bytes = width * 2 + padding * 2}};
    if (width <= 2 * MOST_SIDE && height <= 2 * MOST_SIDE && height > 0) {
        p.bytes[0] = (size_t)(height - 1) * p.target.rgb_stride_bytes + (size_t)width * 3;
        p.bytes[1] = (size_t)(height - 1) * p.target.depth_stride_bytes + (size_t)width * 4;
        p.bytes[2] = (size_t)(height - 1) * p.target.alpha_stride_bytes + (size_t)width * 2;
    }
    p.target.rgb = allocate(p.bytes[0]);
    p.target.depth_q20 = allocate(p.bytes[1]);
    p.target.alpha_q15 = allocate(p.bytes[2]);
    return p;
}

void free_picture(picture *p)
{
    free(p->target.rgb);
    free(p->target.depth_q20);
    free(p->target.alpha_q15);
}
