/* SPDX-License-Identifier: Apache-2.0 */
/* Corners, their descriptors, and the pyramid: integers, so exact; rotated with the picture. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/hash.h"
#include "posing/corners.h"
#include "posing/pyramid.h"
#include "room/room.h"

#define SIDE 256u

static uint8_t grey[SIDE * SIDE], turned[SIDE * SIDE];
static corner corners[CORNERS_MOST], others[CORNERS_MOST];

static void draw(uint32_t frame)
{
    static uint8_t rgb[SIDE * SIDE * 3];
    room_frame(frame, SIDE, SIDE, 1, rgb, NULL);
    for (size_t i = 0; i < SIDE * SIDE; i++) {
        grey[i] = rgb[3 * i + 1];
    }
}

static void test_same_numbers_everywhere(void **state)
{
    (void)state;
    uint32_t count;
    draw(0);
    assert_int_equal(corners_find(grey, SIDE, SIDE, corners, &count), 0);
    uint64_t hash = T3R_HASH_START;
    for (uint32_t i = 0; i < count; i++) {
        hash = t3r_hash_u64(hash, (uint64_t)(uint32_t)corners[i].x_q8 << 32 | (uint32_t)corners[i].y_q8);
        for (int k = 0; k < 4; k++) {
            hash = t3r_hash_u64(hash, corners[i].comparisons[k]);
        }
    }
    if (hash != UINT64_C(0x55e99698ed3c7847)) {
        fail_msg("%u corners, hash %016llx", count, (unsigned long long)hash);
    }
}

static void test_places(void **state)
{
    (void)state;
    uint32_t count, levels[CORNER_LEVELS] = {0}, quarters[4] = {0};
    draw(0);
    assert_int_equal(corners_find(grey, SIDE, SIDE, corners, &count), 0);
    assert_in_range(count, 600, CORNERS_MOST);
    for (uint32_t i = 0; i < count; i++) {
        assert_in_range(corners[i].x_q8, 16 * 256, (SIDE - 17) * 256);
        assert_in_range(corners[i].y_q8, 16 * 256, (SIDE - 17) * 256);
        levels[corners[i].level]++;
        quarters[(corners[i].x_q8 > 128 * 256) + 2 * (corners[i].y_q8 > 128 * 256)]++;
    }
    for (uint32_t i = 0; i < CORNER_LEVELS; i++) {
        assert_true(levels[i] > 10);
    }
    for (uint32_t i = 0; i < 4; i++) {
        assert_true(quarters[i] * 8 > count); /* all of the picture has some */
    }
}

/* A square's corner to a fraction of a pixel. */
static void test_fraction_of_a_pixel(void **state)
{
    (void)state;
    uint32_t count;
    memset(grey, 40, sizeof grey);
    for (uint32_t y = 100; y < 160; y++) {
        for (uint32_t x = 90; x < 150; x++) {
            grey[y * SIDE + x] = 200;
        }
    }
    assert_int_equal(corners_find(grey, SIDE, SIDE, corners, &count), 0);
    int near = 0;
    for (uint32_t i = 0; i < count; i++) {
        /* the edges are at 89.5 and 99.5; Harris' measure has its maximum up to a pixel inside */
        near += corners[i].level == 0 && labs((long)corners[i].x_q8 - 23040) < 384 &&
                labs((long)corners[i].y_q8 - 25600) < 384;
    }
    assert_int_equal(near, 1);
}

/* The picture rotated by a quarter has the same corners, rotated, with the same descriptors. */
static void test_turned_picture(void **state)
{
    (void)state;
    uint32_t count, other_count, found = 0, alike = 0;
    draw(3);
    for (uint32_t y = 0; y < SIDE; y++) {
        for (uint32_t x = 0; x < SIDE; x++) {
            turned[x * SIDE + (SIDE - 1 - y)] = grey[y * SIDE + x];
        }
    }
    assert_int_equal(corners_find(grey, SIDE, SIDE, corners, &count), 0);
    assert_int_equal(corners_find(turned, SIDE, SIDE, others, &other_count), 0);
    for (uint32_t i = 0; i < count; i++) {
        int32_t x = (int32_t)(SIDE - 1) * 256 - corners[i].y_q8, y = corners[i].x_q8;
        for (uint32_t k = 0; k < other_count; k++) {
            if (others[k].level == corners[i].level && abs(others[k].x_q8 - x) < 64 && abs(others[k].y_q8 - y) < 64) {
                found++;
                alike += corners_differ(&corners[i], &others[k]) < 40;
                break;
            }
        }
    }
    assert_true(found * 100 > count * 80);
    assert_true(alike * 100 > found * 90);
}

static void test_small_and_blank_pictures_have_none(void **state)
{
    (void)state;
    uint32_t count;
    memset(grey, 77, sizeof grey);
    assert_int_equal(corners_find(grey, SIDE, SIDE, corners, &count), 0);
    assert_int_equal(count, 0);
    draw(0);
    assert_int_equal(corners_find(grey, SIDE, 47, corners, &count), 0);
    assert_int_equal(count, 0);
    assert_int_equal(corners_find(grey, 2, 2, corners, &count), 0);
    assert_int_equal(count, 0);
}

static void test_pyramid_is_an_average(void **state)
{
    (void)state;
    const uint8_t row[5] = {10, 20, 30, 40, 50};
    uint8_t in[25], out[16];
    for (int i = 0; i < 25; i++) {
        in[i] = row[i % 5];
    }
    pyramid_reduce(in, 5, 5, out);
    /* 10 + 20 / 4 over 5 / 4 ... */
    const uint8_t expected[4] = {12, 24, 36, 48};
    for (int i = 0; i < 16; i++) {
        assert_int_equal(out[i], expected[i % 4]);
    }
    assert_int_equal(pyramid_side(1024), 819);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_numbers_everywhere),
        cmocka_unit_test(test_places),
        cmocka_unit_test(test_fraction_of_a_pixel),
        cmocka_unit_test(test_turned_picture),
        cmocka_unit_test(test_small_and_blank_pictures_have_none),
        cmocka_unit_test(test_pyramid_is_an_average),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
