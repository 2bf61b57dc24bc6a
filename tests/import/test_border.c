/* SPDX-License-Identifier: Apache-2.0 */
/* A border of one colour around pictures of the room is found to the pixel; walls, skies, vignettes and bars are none.
 */
#include <stdlib.h>
#include <string.h>

#include "pictures/picture_border.h"
#include "room/room.h"
#include "test.h"

enum { WIDTH = 160, HEIGHT = 120, PICTURES = 4, VALUES = WIDTH * HEIGHT * 3 };

/* Changes a pixel of picture `index`. */
typedef void painter(uint8_t *rgb, uint32_t x, uint32_t y, uint32_t index);

static uint8_t noise(uint32_t x, uint32_t y, uint32_t most)
{
    return (uint8_t)((x * 2654435761u ^ y * 2246822519u) >> 13 & most);
}

static void fill(uint8_t *rgb, uint8_t level)
{
    memset(rgb, level, 3);
}

/* Searches the border of pictures of the room, painted over. */
static picture_inner search_pictures(painter *paint)
{
    border_search search;
    border_search_begin(&search);
    uint8_t *rgb = malloc(VALUES);
    for (uint32_t i = 0; i < PICTURES; i++) {
        room_frame(i, WIDTH, HEIGHT, 1, rgb, NULL);
        for (uint32_t at = 0; at < WIDTH * HEIGHT; at++) {
            paint(rgb + (size_t)3 * at, at % WIDTH, at / WIDTH, i);
        }
        const picture p = {.width = WIDTH, .height = HEIGHT, .channels = 3, .bits = 8, .samples = rgb};
        assert_int_equal(border_search_add(&search, &p), 0);
    }
    free(rgb);
    return border_search_end(&search);
}

static void assert_part(picture_inner found, t3r_crop due)
{
    assert_int_equal(found.width, WIDTH);
    assert_int_equal(found.height, HEIGHT);
    assert_memory_equal(&found.part, &due, sizeof due);
}

/* Whether the pixel is within so many pixels of a side. */
static bool is_outside(uint32_t x, uint32_t y, uint32_t left, uint32_t top, uint32_t right, uint32_t bottom)
{
    return x < left || y < top || x >= WIDTH - right || y >= HEIGHT - bottom;
}

static void paint_white(uint8_t *rgb, uint32_t x, uint32_t y, uint32_t index)
{
    (void)index;
    if (is_outside(x, y, 5, 3, 6, 2)) {
        fill(rgb, (uint8_t)(255 - noise(x, y, 15)));
    }
}

/* Paints a border whose last line is half of the picture's. */
static void paint_blended(uint8_t *rgb, uint32_t x, uint32_t y, uint32_t index)
{
    (void)index;
    if (is_outside(x, y, 4, 4, 4, 4)) {
        fill(rgb, noise(x, y, 7));
    } else if (is_outside(x, y, 5, 5, 5, 5)) {
        for (int c = 0; c < 3; c++) {
            rgb[c] /= 3;
        }
    }
}

TEST(test_a_border_is_found_to_the_pixel)
{
    assert_part(search_pictures(paint_white), (t3r_crop){5, 3, WIDTH - 11, HEIGHT - 5});
    assert_part(search_pictures(paint_blended), (t3r_crop){5, 5, WIDTH - 10, HEIGHT - 10});
}

static void paint_nothing(uint8_t *rgb, uint32_t x, uint32_t y, uint32_t index)
{
    (void)rgb, (void)x, (void)y, (void)index;
}

static void paint_wall(uint8_t *rgb, uint32_t x, uint32_t y, uint32_t index)
{
    (void)index;
    fill(rgb, (uint8_t)(244 + noise(x, y, 7)));
}

/* Paints a wall around what hangs on it. */
static void paint_wall_around(uint8_t *rgb, uint32_t x, uint32_t y, uint32_t index)
{
    if (is_outside(x, y, 30, 25, 30, 25)) {
        paint_wall(rgb, x, y, index);
    }
}

static void paint_sky(uint8_t *rgb, uint32_t x, uint32_t y, uint32_t index)
{
    (void)index;
    if (y < HEIGHT / 2) {
        fill(rgb, noise(x, y, 3));
    }
}

static void paint_vignette(uint8_t *rgb, uint32_t x, uint32_t y, uint32_t index)
{
    (void)index;
    const int32_t across = 2 * (int32_t)x - WIDTH + 1, down = 2 * (int32_t)y - HEIGHT + 1;
    const int32_t part = 256 - 256 * across * across / (WIDTH * WIDTH) - 256 * down * down / (HEIGHT * HEIGHT);
    for (int c = 0; c < 3; c++) {
        rgb[c] = (uint8_t)(rgb[c] * (part > 0 ? part : 0) / 256);
    }
}

static void paint_bars(uint8_t *rgb, uint32_t x, uint32_t y, uint32_t index)
{
    (void)index;
    if (is_outside(x, y, 0, 6, 0, 6)) {
        fill(rgb, 0);
    }
}

static void paint_wide(uint8_t *rgb, uint32_t x, uint32_t y, uint32_t index)
{
    (void)index;
    if (is_outside(x, y, 16, 12, 16, 12)) {
        fill(rgb, 255);
    }
}

/* Paints a border whose edges are aslant. */
static void paint_aslant(uint8_t *rgb, uint32_t x, uint32_t y, uint32_t index)
{
    (void)index;
    const uint32_t across = 1 + x * 8 / WIDTH, down = 1 + y * 8 / HEIGHT;
    if (is_outside(x, y, down, across, down, across)) {
        fill(rgb, 0);
    }
}

static void paint_all_but_one(uint8_t *rgb, uint32_t x, uint32_t y, uint32_t index)
{
    if (index != 2) {
        paint_white(rgb, x, y, index);
    }
}

TEST(test_what_is_no_border)
{
    painter *const none[] = {paint_nothing, paint_wall, paint_wall_around, paint_sky,        paint_vignette,
                             paint_bars,    paint_wide, paint_aslant,      paint_all_but_one};
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        const picture_inner found = search_pictures(none[i]);
        if (found.width != 0) {
            fail_msg("painter %zu: a border", i);
        }
    }
}

/* Checks that pictures of several sizes, and of a few pixels, have no border. */
TEST(test_sizes)
{
    uint8_t white[32 * 32 * 3];
    memset(white, 255, sizeof white);
    for (uint32_t width = 1; width < 32; width++) {
        border_search search;
        border_search_begin(&search);
        picture p = {.width = width, .height = 8, .channels = 3, .bits = 8, .samples = white};
        assert_int_equal(border_search_add(&search, &p), 0);
        p.height = 16;
        assert_int_equal(border_search_add(&search, &p), 0);
        assert_false(search.possible);
        assert_int_equal(border_search_end(&search).width, 0);
    }
}
