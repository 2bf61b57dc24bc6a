/* SPDX-License-Identifier: Apache-2.0 */
#include "pictures/picture_shape.h"

#include <stdlib.h>
#include <string.h>

#include "pictures/exif.h"
#include "trim3r.h"

/* Whether an orientation swaps the sides, and then mirrors along x and y. */
static const struct move {
    bool swaps, x, y;
} moves[9] = {
    {false, false, false}, {false, false, false}, {false, true, false}, {false, true, true}, {false, false, true},
    {true, false, false},  {true, true, false},   {true, true, true},   {true, false, true},
};

/* Copies a plane of `channels` bytes a pixel to its turned place. */
static void turn_plane(const picture *p, const uint8_t *from, uint32_t channels, uint8_t *to)
{
    const struct move m = moves[p->orientation];
    const uint32_t width = m.swaps ? p->height : p->width, height = m.swaps ? p->width : p->height;
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            const uint32_t across = m.x ? width - 1 - x : x, down = m.y ? height - 1 - y : y;
            const size_t at = m.swaps ? (size_t)across * p->width + down : (size_t)down * p->width + across;
            memcpy(to + ((size_t)y * width + x) * channels, from + at * channels, channels);
        }
    }
}

int picture_turn(picture *p)
{
    const size_t pixels = (size_t)p->width * p->height;
    uint8_t *samples = malloc(pixels * p->channels), *valid = p->valid != NULL ? malloc(pixels) : NULL;
    if (samples == NULL || (p->valid != NULL && valid == NULL)) {
        free(samples);
        free(valid);
        return -1;
    }
    turn_plane(p, p->samples, p->channels, samples);
    if (valid != NULL) {
        turn_plane(p, p->valid, 1, valid);
    }
    picture out = *p;
    out.width = moves[p->orientation].swaps ? p->height : p->width;
    out.height = moves[p->orientation].swaps ? p->width : p->height;
    out.orientation = EXIF_UPRIGHT;
    out.samples = samples;
    out.valid = valid;
    picture_free(p);
    *p = out;
    return 0;
}

/* Averages one square into a pixel of the smaller picture, which lies before the square in memory. */
static void reduce_square(picture *p, uint32_t n, uint32_t x, uint32_t y, size_t to)
{
    uint8_t *samples = p->samples;
    uint64_t sums[3] = {0};
    uint32_t count = 0;
    for (uint32_t j = 0; j < n; j++) {
        for (uint32_t i = 0; i < n; i++) {
            const size_t at = (size_t)(y * n + j) * p->width + x * n + i;
            if (p->valid == NULL || p->valid[at] != 0) {
                for (uint32_t c = 0; c < p->channels; c++) {
                    sums[c] += samples[at * p->channels + c];
                }
                count++;
            }
        }
    }
    for (uint32_t c = 0; c < p->channels; c++) {
        samples[to * p->channels + c] = (uint8_t)(count > 0 ? (2 * sums[c] + count) / (2 * count) : 0);
    }
    if (p->valid != NULL) {
        p->valid[to] = 2 * count >= n * n;
    }
}

void picture_reduce(picture *p, uint32_t n)
{
    const uint32_t width = p->width / n, height = p->height / n;
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            reduce_square(p, n, x, y, (size_t)y * width + x);
        }
    }
    p->width = width;
    p->height = height;
}

uint32_t picture_reduction(uint32_t width, uint32_t height)
{
    const uint32_t longer = width > height ? width : height;
    return (longer + T3R_MAX_SIDE - 1) / T3R_MAX_SIDE;
}

/* Moves the part of a plane of `bytes` a pixel to its start. */
static void crop_plane(uint8_t *plane, uint32_t width, uint32_t bytes, const t3r_crop *part)
{
    for (uint32_t y = 0; y < part->height; y++) {
        memmove(plane + (size_t)y * part->width * bytes, plane + ((size_t)(part->y + y) * width + part->x) * bytes,
                (size_t)part->width * bytes);
    }
}

void picture_crop(picture *p, const t3r_crop *part)
{
    crop_plane(p->samples, p->width, p->channels * p->bits / 8, part);
    if (p->valid != NULL) {
        crop_plane(p->valid, p->width, 1, part);
    }
    p->width = part->width;
    p->height = part->height;
}

int picture_keep_bright(picture *p)
{
    static const uint8_t black[3] = {0};
    const size_t pixels = (size_t)p->width * p->height;
    const uint8_t *samples = p->samples;
    if (p->valid == NULL) {
        p->valid = malloc(pixels);
        if (p->valid == NULL) {
            return -1;
        }
        memset(p->valid, 1, pixels);
    }
    for (size_t i = 0; i < pixels; i++) {
        p->valid[i] = p->valid[i] != 0 && memcmp(samples + i * p->channels, black, p->channels) != 0;
    }
    return 0;
}

bool picture_blacken(picture *p)
{
    uint8_t *samples = p->samples;
    bool any = p->valid == NULL;
    for (size_t i = 0; i < (size_t)p->width * p->height && p->valid != NULL; i++) {
        any = any || p->valid[i] != 0;
        if (p->valid[i] == 0) {
            memset(samples + i * p->channels, 0, p->channels);
        }
    }
    return any;
}

bool picture_valid_at(const picture *p, uint32_t x, uint32_t y, const picture *of)
{
    const uint32_t across = (uint32_t)((2 * (uint64_t)x + 1) * p->width / (2 * (uint64_t)of->width));
    const uint32_t down = (uint32_t)((2 * (uint64_t)y + 1) * p->height / (2 * (uint64_t)of->height));
    return p->valid == NULL || p->valid[(size_t)down * p->width + across] != 0;
}
