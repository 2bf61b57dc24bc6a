/* SPDX-License-Identifier: Apache-2.0 */
/* The built-in room: its bits, and that pictures, depth and poses show the same room. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/hash.h"
#include "room/room.h"
#include "test.h"

#define SIDE ROOM_SIDE
#define PIXELS ((size_t)SIDE * SIDE)

typedef struct shot {
    uint8_t rgb[PIXELS * 3];
    uint16_t depth[PIXELS];
    t3r_recorded_camera camera;
} shot;

static shot shots[ROOM_FRAMES];

static int draw_all(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < ROOM_FRAMES; i++) {
        room_frame(i, SIDE, SIDE, 1, shots[i].rgb, shots[i].depth);
        room_recorded_camera(i, SIDE, SIDE, &shots[i].camera);
    }
    return 0;
}

static uint64_t shot_hash(const uint8_t *rgb, const uint16_t *depth, size_t pixels)
{
    return t3r_hash_u16s(t3r_hash_bytes(T3R_HASH_START, rgb, pixels * 3), depth, pixels);
}

/* Checks colour, then depth, for each frame; 256x256, seed 1. A change here changes every later golden hash. */
TEST(test_golden_frames)
{
    static const uint64_t golden[ROOM_FRAMES] = {UINT64_C(0xeadf6d423bc46517), UINT64_C(0x4c6d2227cda114a9),
                                                 UINT64_C(0x87875bfe509f7cef), UINT64_C(0x135eb030bb8f5e65),
                                                 UINT64_C(0xf7ec329b64c547ef), UINT64_C(0x78b6cf890dcf1b48)};
    for (uint32_t i = 0; i < ROOM_FRAMES; i++) {
        uint64_t hash = shot_hash(shots[i].rgb, shots[i].depth, PIXELS);
        if (hash != golden[i]) {
            fail_msg("frame %u: %016llx, not %016llx", i, (unsigned long long)hash, (unsigned long long)golden[i]);
        }
    }
}

TEST(test_golden_cameras)
{
    uint64_t hash = T3R_HASH_START;
    for (uint32_t i = 0; i < 70; i++) {
        t3r_camera c;
        room_camera(i, 640, 480, &c);
        hash = t3r_hash_u32(t3r_hash_u32(hash, (uint32_t)c.fx_q16), (uint32_t)c.cy_q16);
        for (int k = 0; k < 3; k++) {
            hash = t3r_hash_u64(hash, (uint64_t)c.position_q32[k]);
        }
        for (int k = 0; k < 4; k++) {
            hash = t3r_hash_u32(hash, (uint32_t)c.rotation_q30[k]);
        }
    }
    if (hash != UINT64_C(0x91c39277353df4a7)) {
        fail_msg("cameras: %016llx", (unsigned long long)hash);
    }
}

TEST(test_depth_is_in_the_room)
{
    for (uint32_t i = 0; i < ROOM_FRAMES; i++) {
        for (size_t k = 0; k < PIXELS; k++) {
            assert_in_range(shots[i].depth[k], 1200, 4700);
        }
        t3r_recorded_camera c = shots[i].camera;
        double norm = 0;
        for (int k = 0; k < 4; k++) {
            norm += c.rotation[k] * c.rotation[k];
        }
        assert_true(fabs(norm - 1) < 1e-8);
        /* 60 degrees */
        assert_true(fabs(2 * atan(SIDE / 2.0 / c.fx) - 3.14159265358979 / 3) < 1e-5);
        assert_true(c.cx == 127.5 && c.cy == 127.5);
    }
}

static void rotate(const double q[4], const double v[3], double out[3])
{
    double t[3];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        t[i] = 2 * (q[1 + j] * v[k] - q[1 + k] * v[j]);
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = v[i] + q[0] * t[i] + q[1 + j] * t[k] - q[1 + k] * t[j];
    }
}

/* Pixels of a projected into b by a's depth and both poses: how many arrive, how many of them find their own depth
 * (within 15 mm), and how well the colours agree. */
typedef struct agreement {
    double landed, same_depth, colour_error;
} agreement;

static agreement warp(const shot *a, const shot *b)
{
    agreement out = {0};
    const double *q = b->camera.rotation, backwards[4] = {q[0], -q[1], -q[2], -q[3]};
    for (uint32_t y = 0; y < SIDE; y++) {
        for (uint32_t x = 0; x < SIDE; x++) {
            double z = a->depth[y * SIDE + x] / 1000.0, world[3], seen[3];
            double point[3] = {(x - a->camera.cx) / a->camera.fx * z, (y - a->camera.cy) / a->camera.fy * z, z};
            rotate(a->camera.rotation, point, world);
            for (int k = 0; k < 3; k++) {
                world[k] += a->camera.position[k] - b->camera.position[k];
            }
            rotate(backwards, world, seen);
            double u = seen[0] / seen[2] * b->camera.fx + b->camera.cx + 0.5;
            double v = seen[1] / seen[2] * b->camera.fy + b->camera.cy + 0.5;
            if (seen[2] <= 0 || u < 0 || v < 0 || u >= SIDE || v >= SIDE) {
                continue;
            }
            size_t at = (size_t)v * SIDE + (size_t)u;
            out.landed++;
            if (fabs(b->depth[at] / 1000.0 - seen[2]) < 0.015) {
                out.same_depth++;
                for (int c = 0; c < 3; c++) {
                    out.colour_error += abs(a->rgb[(y * SIDE + x) * 3 + (uint32_t)c] - b->rgb[at * 3 + (size_t)c]);
                }
            }
        }
    }
    out.colour_error /= 3 * out.same_depth;
    out.same_depth /= out.landed;
    out.landed /= PIXELS;
    return out;
}

TEST(test_views_agree)
{
    for (uint32_t i = 0; i < ROOM_FRAMES; i++) {
        for (uint32_t k = 0; k < ROOM_FRAMES; k++) {
            agreement g = warp(&shots[i], &shots[k]);
            print_message("%u to %u: %.3f land, %.3f of them at their depth, colours %.2f levels apart\n", i, k,
                          g.landed, g.same_depth, g.colour_error);
            assert_true(g.landed > 0.75);
            assert_true(g.same_depth > (i == k ? 0.999 : 0.8));
            assert_true(g.colour_error < 7);
        }
    }
    /* a camera half a degree off is distinguishable from the right one */
    shot turned = shots[1];
    turned.camera.rotation[2] += 0.005;
    agreement right = warp(&shots[0], &shots[1]), wrong = warp(&shots[0], &turned);
    assert_true(wrong.colour_error > 1.2 * right.colour_error);
}

static int by_value(const void *a, const void *b)
{
    return *(const uint16_t *)a - *(const uint16_t *)b;
}

TEST(test_triplets_have_a_baseline)
{
    t3r_triplet t[ROOM_MAX_TRIPLETS];
    assert_int_equal(room_triplets(2, t), 0);
    assert_int_equal(room_triplets(5, t), 1);
    assert_int_equal(room_triplets(ROOM_FRAMES, t), 3);
    for (uint32_t i = 0; i < 3; i++) {
        const shot *a = &shots[t[i].context[0]], *b = &shots[t[i].context[1]];
        uint16_t sorted[PIXELS];
        memcpy(sorted, a->depth, sizeof sorted);
        qsort(sorted, PIXELS, sizeof *sorted, by_value);
        double baseline = 0;
        for (int k = 0; k < 3; k++) {
            double apart = a->camera.position[k] - b->camera.position[k];
            baseline += apart * apart;
        }
        double ratio = sqrt(baseline) / (sorted[PIXELS / 2] / 1000.0);
        assert_true(ratio > 0.1 && ratio < 0.3);
    }
}

TEST(test_seeds_sizes_and_frames)
{
    static uint8_t a[64 * 48 * 3], b[64 * 48 * 3];
    static uint16_t depth[64 * 48], other[64 * 48];
    room_frame(3, 64, 48, 1, a, depth);
    room_frame(3, 64, 48, 2, b, other);
    assert_memory_equal(depth, other, sizeof depth);
    assert_memory_not_equal(a, b, sizeof a);
    /* the same picture without depth */
    room_frame(3, 64, 48, 1, b, NULL);
    assert_memory_equal(a, b, sizeof a);
    /* the default frames have six poses, and no later one is stationary */
    for (uint32_t i = 1; i < 70; i++) {
        for (uint32_t k = i < ROOM_FRAMES ? 0 : i - 1; k < i; k++) {
            t3r_camera p, q;
            room_camera(i, 64, 48, &p);
            room_camera(k, 64, 48, &q);
            assert_memory_not_equal(p.position_q32, q.position_q32, sizeof p.position_q32);
        }
    }
    /* the smallest picture */
    room_frame(999, 8, 8, 0, a, depth);
    assert_in_range(depth[0], 1, 5000);
}

ALL_TESTS_WITH(draw_all, NULL)
