/* SPDX-License-Identifier: Apache-2.0 */
#include "posing/descriptor.h"

#include <stddef.h>
#include <string.h>

#define RADIUS 15 /* of the disc whose centroid gives the direction */
#define REACH 13  /* of the pattern, before and after turning: with the 5 x 5 sums within DESCRIPTOR_BORDER */
#define TURNS 32

/* round(2^14 cos(2 pi k / 32)) */
static const int32_t cosine_q14[TURNS] = {
    16384,  16069,  15137,  13623,  11585,  9102,  6270,  3196,  0, -3196, -6270, -9102, -11585, -13623, -15137, -16069,
    -16384, -16069, -15137, -13623, -11585, -9102, -6270, -3196, 0, 3196,  6270,  9102,  11585,  13623,  15137,  16069};

static int32_t sine_q14(uint32_t turn)
{
    return cosine_q14[(turn + TURNS - TURNS / 4) % TURNS];
}

void descriptor_smooth(const uint8_t *grey, uint32_t width, uint32_t height, uint16_t *smoothed)
{
    memset(smoothed, 0, (size_t)width * height * sizeof *smoothed);
    for (uint32_t y = 2; y + 2 < height; y++) {
        for (uint32_t x = 2; x + 2 < width; x++) {
            uint32_t sum = 0;
            for (uint32_t v = y - 2; v <= y + 2; v++) {
                const uint8_t *row = grey + (size_t)v * width + x;
                sum += (uint32_t)row[-2] + row[-1] + row[0] + row[1] + row[2];
            }
            smoothed[(size_t)y * width + x] = (uint16_t)sum;
        }
    }
}

/* The direction of 32 that lies nearest to the one from the place to the patch's centroid. */
static uint32_t direction(const uint8_t *grey, uint32_t width, uint32_t x, uint32_t y)
{
    int32_t mx = 0, my = 0; /* below 2^18 x 2^4 each */
    for (int32_t v = -RADIUS; v <= RADIUS; v++) {
        const uint8_t *row = grey + (ptrdiff_t)((int32_t)y + v) * (ptrdiff_t)width + x;
        for (int32_t u = -RADIUS; u <= RADIUS; u++) {
            if (u * u + v * v <= RADIUS * RADIUS) {
                mx += u * row[u];
                my += v * row[u];
            }
        }
    }
    uint32_t best = 0;
    int64_t most = INT64_MIN;
    for (uint32_t k = 0; k < TURNS; k++) {
        int64_t along = (int64_t)mx * cosine_q14[k] + (int64_t)my * sine_q14(k);
        if (along > most) {
            most = along;
            best = k;
        }
    }
    return best;
}

/* About Gaussian with a deviation of 5.4: the mean of three uniform numbers of -16..16, within REACH. */
static int32_t place(uint64_t *state)
{
    int32_t sum = 0;
    for (int i = 0; i < 3; i++) {
        *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        sum += (int32_t)((*state >> 33) % 33) - 16;
    }
    return sum / 3;
}

static void next_place(uint64_t *state, int32_t *x, int32_t *y)
{
    do {
        *x = place(state);
        *y = place(state);
    } while (*x * *x + *y * *y > REACH * REACH);
}

static uint16_t turned(const uint16_t *smoothed, uint32_t width, uint32_t turn, int32_t x, int32_t y)
{
    int32_t c = cosine_q14[turn], s = sine_q14(turn);
    int32_t u = (x * c - y * s + (1 << 13)) >> 14, v = (x * s + y * c + (1 << 13)) >> 14;
    return smoothed[(ptrdiff_t)v * (ptrdiff_t)width + u];
}

void descriptor_compare(const uint8_t *grey, const uint16_t *smoothed, uint32_t width, uint32_t x, uint32_t y,
                        uint64_t comparisons[4])
{
    uint32_t turn = direction(grey, width, x, y);
    const uint16_t *centre = smoothed + (size_t)y * width + x;
    uint64_t state = 1;
    for (uint32_t i = 0; i < 256; i++) {
        int32_t x0, y0, x1, y1;
        next_place(&state, &x0, &y0);
        next_place(&state, &x1, &y1);
        uint64_t bit = turned(centre, width, turn, x0, y0) < turned(centre, width, turn, x1, y1);
        comparisons[i / 64] = i % 64 == 0 ? bit : comparisons[i / 64] | bit << i % 64;
    }
}
