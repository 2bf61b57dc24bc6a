/* SPDX-License-Identifier: Apache-2.0 */
/* Depth as OpenEXR: files of the library are read in steps; files without depth, truncated or damaged ones are
 * refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "host/file_bytes.h"
#include "import/depth/exr_depth.h"
#include "import/depth/raw_depth.h"
#include "scratch.h"

#ifdef T3R_EXR
#include <openexr.h>

enum { WIDTH = 45, HEIGHT = 37, TILE = 16, LEFT = -3, TOP = 7 };
#define UNIT 0.001

/* A file to write, of `lengths` in float, or of `halves` if given. */
typedef struct made {
    exr_compression_t packing;
    exr_pixel_type_t type;
    exr_storage_t storage;
    uint32_t channels;
    int32_t narrower; /* difference of the display window's width and the data window's */
    int32_t tile;     /* side of a tile */
} made;

static float lengths[HEIGHT][WIDTH];
static uint16_t halves[HEIGHT][WIDTH];

/* Fills in metres with gaps of every kind of missing depth, and one value between two steps. Halves: powers of two. */
static void fill(void)
{
    static const float none[] = {0, -1.5f, 66, (float)0x1p-12};
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        lengths[i / WIDTH][i % WIDTH] = (float)(0.2 + 0.0137 * i);
        halves[i / WIDTH][i % WIDTH] = (uint16_t)((i % 19 + 5) << 10); /* 2^(i % 19 - 10) */
    }
    memcpy(lengths[3], none, sizeof none);
    lengths[4][0] = NAN;
    lengths[4][1] = INFINITY;
    lengths[4][2] = 0.0625f;
    halves[3][0] = 0x7e00; /* NaN */
    halves[3][1] = 0x7c00; /* infinity */
    halves[3][2] = 0xc000; /* -2 */
}

static double length_at(const made *m, int x, int y)
{
    return m->type == EXR_PIXEL_FLOAT ? (double)lengths[y][x]
           : y == 3 && x < 3          ? 0
                                      : ldexp(1, (y * WIDTH + x) % 19 - 10);
}

static void write_chunk(exr_context_t context, const made *m, const exr_chunk_info_t *chunk, int x, int y)
{
    exr_encode_pipeline_t work = EXR_ENCODE_PIPELINE_INITIALIZER;
    const int bytes = m->type == EXR_PIXEL_HALF ? 2 : 4;
    const uint8_t *from = m->type == EXR_PIXEL_HALF ? (const uint8_t *)&halves[y][x] : (const uint8_t *)&lengths[y][x];
    assert_int_equal(exr_encoding_initialize(context, 0, chunk, &work), EXR_ERR_SUCCESS);
    for (uint32_t i = 0; i < m->channels; i++) {
        work.channels[i].encode_from_ptr = from;
        work.channels[i].user_pixel_stride = bytes;
        work.channels[i].user_line_stride = bytes * WIDTH;
    }
    assert_int_equal(exr_encoding_choose_default_routines(context, 0, &work), EXR_ERR_SUCCESS);
    assert_int_equal(exr_encoding_run(context, 0, &work), EXR_ERR_SUCCESS);
    exr_encoding_destroy(context, &work);
}

static void write_chunks(exr_context_t context, const made *m)
{
    exr_chunk_info_t chunk;
    int32_t lines = m->tile;
    if (m->storage == EXR_STORAGE_SCANLINE) {
        assert_int_equal(exr_get_scanlines_per_chunk(context, 0, &lines), EXR_ERR_SUCCESS);
    }
    for (int y = 0; y < HEIGHT; y += lines) {
        if (m->storage == EXR_STORAGE_SCANLINE) {
            assert_int_equal(exr_write_scanline_chunk_info(context, 0, TOP + y, &chunk), EXR_ERR_SUCCESS);
            write_chunk(context, m, &chunk, 0, y);
            continue;
        }
        for (int x = 0; x < WIDTH; x += m->tile) {
            assert_int_equal(exr_write_tile_chunk_info(context, 0, x / m->tile, y / m->tile, 0, 0, &chunk),
                             EXR_ERR_SUCCESS);
            write_chunk(context, m, &chunk, x, y);
        }
    }
}

static const char *write_exr(scratch *s, const made *m)
{
    static const char *const names[] = {"V", "W", "Z"};
    const exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_attr_box2i_t window, display;
    exr_attr_v2f_t centre;
    exr_context_t context;
    int part;
    window.min.x = LEFT;
    window.min.y = TOP;
    window.max.x = LEFT + WIDTH - 1;
    window.max.y = TOP + HEIGHT - 1;
    display = window;
    display.max.x += m->narrower;
    centre.x = centre.y = 0;
    assert_int_equal(exr_start_write(&context, scratch_path(s, "a.exr"), EXR_WRITE_FILE_DIRECTLY, &how),
                     EXR_ERR_SUCCESS);
    assert_int_equal(exr_add_part(context, "depth", m->storage, &part), EXR_ERR_SUCCESS);
    assert_int_equal(exr_initialize_required_attr(context, 0, &display, &window, 1, &centre, 1,
                                                  EXR_LINEORDER_INCREASING_Y, m->packing),
                     EXR_ERR_SUCCESS);
    for (uint32_t i = 0; i < m->channels; i++) {
        assert_int_equal(exr_add_channel(context, 0, names[i], m->type, EXR_PERCEPTUALLY_LINEAR, 1, 1),
                         EXR_ERR_SUCCESS);
    }
    if (m->storage == EXR_STORAGE_TILED) {
        assert_int_equal(exr_set_tile_descriptor(context, 0, (uint32_t)m->tile, (uint32_t)m->tile, EXR_TILE_ONE_LEVEL,
                                                 EXR_TILE_ROUND_DOWN),
                         EXR_ERR_SUCCESS);
    }
    assert_int_equal(exr_write_header(context), EXR_ERR_SUCCESS);
    write_chunks(context, m);
    assert_int_equal(exr_finish(&context), EXR_ERR_SUCCESS);
    return s->path;
}

static void check_read(scratch *s, const made *m)
{
    char error[512] = "";
    picture depth = {0};
    uint32_t sides[2];
    /* this compression keeps 24 bits of a float */
    const int off = m->packing == EXR_COMPRESSION_PXR24 && m->type == EXR_PIXEL_FLOAT ? 1 : 0;
    write_exr(s, m);
    if (exr_depth_read(s->path, UNIT, &depth, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    assert_int_equal(exr_depth_size(s->path, &sides[0], &sides[1], error, sizeof error), 0);
    assert_int_equal(depth.width, WIDTH);
    assert_int_equal(depth.height, HEIGHT);
    assert_int_equal(depth.bits * depth.channels, 16);
    assert_true(sides[0] == WIDTH && sides[1] == HEIGHT);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            const double steps = nearbyint(length_at(m, x, y) / UNIT);
            const int wanted = steps >= 1 && steps <= UINT16_MAX ? (int)steps : 0;
            const int got = ((const uint16_t *)depth.samples)[y * WIDTH + x];
            assert_in_range(got + off, wanted, wanted + 2 * off);
            assert_true((got == 0) == (wanted == 0));
        }
    }
    picture_free(&depth);
}

static void test_every_storage_is_read(void **state)
{
    static const exr_storage_t storages[] = {EXR_STORAGE_SCANLINE, EXR_STORAGE_TILED};
    static const exr_pixel_type_t types[] = {EXR_PIXEL_FLOAT, EXR_PIXEL_HALF};
    for (exr_compression_t packing = EXR_COMPRESSION_NONE; packing <= EXR_COMPRESSION_PXR24; packing++) {
        for (size_t i = 0; i < 4; i++) {
            check_read(*state, &(made){packing, types[i % 2], storages[i / 2], 1, 0, TILE});
        }
    }
    check_read(*state, &(made){EXR_COMPRESSION_ZIP, EXR_PIXEL_FLOAT, EXR_STORAGE_TILED, 1, 0, 64}); /* one tile */
}

/* The unit refers to the lengths; halves of a step are rounded to even. */
static void test_steps(void **state)
{
    (void)state;
    assert_int_equal(raw_depth_step(2.5f, 1), 2);
    assert_int_equal(raw_depth_step(3.5f, 1), 4);
    assert_int_equal(raw_depth_step(0.5f, 1), 0);
    assert_int_equal(raw_depth_step(65535.4f, 1), 65535);
    assert_int_equal(raw_depth_step(65535.5f, 1), 0);
    assert_int_equal(raw_depth_step(INFINITY, 1), 0);
    assert_int_equal(raw_depth_step(NAN, 1), 0);
    assert_int_equal(raw_depth_step(-4, 1), 0);
}

static void check_refused(scratch *s, double unit, const char *why)
{
    char error[512] = "";
    picture depth = {0};
    assert_int_equal(exr_depth_read(s->path, unit, &depth, error, sizeof error), -1);
    assert_null(depth.samples);
    if (strncmp(error, s->path, strlen(s->path)) != 0 || strstr(error, why) == NULL) {
        fail_msg("%s: does not name the file and say: %s", error, why);
    }
}

static void test_other_kinds_are_refused(void **state)
{
    scratch *s = *state;
    write_exr(s, &(made){EXR_COMPRESSION_ZIP, EXR_PIXEL_FLOAT, EXR_STORAGE_SCANLINE, 3, 0, TILE});
    check_refused(s, UNIT, "not one channel");
    write_exr(s, &(made){EXR_COMPRESSION_ZIP, EXR_PIXEL_UINT, EXR_STORAGE_SCANLINE, 1, 0, TILE});
    check_refused(s, UNIT, "neither half nor float");
    write_exr(s, &(made){EXR_COMPRESSION_B44, EXR_PIXEL_HALF, EXR_STORAGE_SCANLINE, 1, 0, TILE});
    check_refused(s, UNIT, "packed by B44 or DWA");
    write_exr(s, &(made){EXR_COMPRESSION_ZIP, EXR_PIXEL_FLOAT, EXR_STORAGE_SCANLINE, 1, 1, TILE});
    check_refused(s, UNIT, "data window is not its display window");
    write_exr(s, &(made){EXR_COMPRESSION_ZIP, EXR_PIXEL_FLOAT, EXR_STORAGE_SCANLINE, 1, 0, TILE});
    check_refused(s, 1e9, "no length in it is from 1 to 65535 steps of 1e+09");
    write_exr(s, &(made){EXR_COMPRESSION_ZIP, EXR_PIXEL_FLOAT, EXR_STORAGE_TILED, 1, 0, 4});
    check_refused(s, UNIT, "sides of tiles are not from 8 to 1024 pixels");
    scratch_write(s, "a.exr", "not a picture of any kind", 25);
    check_refused(s, UNIT, "OpenEXR: ");
    scratch_write(s, "a.exr", "", 0);
    check_refused(s, UNIT, "OpenEXR: ");
}

/* Returns where the bytes of `text` begin, plus `beyond`. */
static uint8_t *behind(uint8_t *bytes, size_t count, const char *text, size_t beyond)
{
    for (size_t at = 0; at + strlen(text) + beyond + 16 < count; at++) {
        if (memcmp(bytes + at, text, strlen(text)) == 0) {
            return bytes + at + beyond;
        }
    }
    fail_msg("no %s in the file", text);
    return bytes;
}

/* Huge sides in a header are refused. */
static void test_sides_are_bounded(void **state)
{
    scratch *s = *state;
    char error[512];
    size_t count;
    write_exr(s, &(made){EXR_COMPRESSION_ZIP, EXR_PIXEL_FLOAT, EXR_STORAGE_SCANLINE, 1, 0, TILE});
    uint8_t *bytes = t3r_file_bytes(s->path, SIZE_MAX, &count, error, sizeof error);
    assert_non_null(bytes);
    for (int i = 0; i < 2; i++) {
        static const char *const names[] = {"dataWindow\0box2i", "displayWindow\0box2i"};
        const int32_t window[4] = {0, 0, INT32_MAX - 1, INT32_MAX - 1};
        const char *name = names[i];
        memcpy(behind(bytes, count, name, strlen(name) + 1 + sizeof "box2i" + 4), window, sizeof window);
    }
    scratch_write(s, "a.exr", bytes, count);
    check_refused(s, UNIT, "OpenEXR: ");
    free(bytes);
}

/* Whether the file gives samples; otherwise it must give an error. */
static bool is_read(const uint8_t *bytes, size_t count)
{
    char error[512] = "";
    picture depth = {0};
    const int status = exr_depth_parse(bytes, count, UNIT, &depth, error, sizeof error);
    assert_true((status != 0) == (error[0] != '\0'));
    assert_true((status == 0) == (depth.samples != NULL));
    picture_free(&depth);
    return status == 0;
}

static void check_damage(scratch *s, const made *m)
{
    char error[512];
    size_t count;
    write_exr(s, m);
    uint8_t *bytes = t3r_file_bytes(s->path, SIZE_MAX, &count, error, sizeof error);
    assert_non_null(bytes);
    assert_true(is_read(bytes, count));
    for (size_t cut = 0; cut < count; cut += cut < 500 ? 1 : 37) { /* byte by byte in the header */
        uint8_t *part = malloc(cut + 1);                           /* so that a read beyond it is noticed */
        memcpy(part, bytes, cut);
        assert_false(is_read(part, cut));
        free(part);
    }
    uint32_t x = 12345;
    for (int i = 0; i < 600; i++) {
        x = x * 1664525u + 1013904223u;
        const size_t at = (i < 400 ? x >> 8 : (x >> 8) % 600) % count;
        const uint8_t before = bytes[at];
        bytes[at] ^= (uint8_t)(1u << (x & 7));
        (void)is_read(bytes, count);
        bytes[at] = before;
    }
    free(bytes);
}

static void test_damage_is_no_crash(void **state)
{
    check_damage(*state, &(made){EXR_COMPRESSION_ZIP, EXR_PIXEL_FLOAT, EXR_STORAGE_SCANLINE, 1, 0, TILE});
    check_damage(*state, &(made){EXR_COMPRESSION_PIZ, EXR_PIXEL_HALF, EXR_STORAGE_SCANLINE, 1, 0, TILE});
    check_damage(*state, &(made){EXR_COMPRESSION_PXR24, EXR_PIXEL_FLOAT, EXR_STORAGE_SCANLINE, 1, 0, TILE});
    check_damage(*state, &(made){EXR_COMPRESSION_RLE, EXR_PIXEL_FLOAT, EXR_STORAGE_TILED, 1, 0, TILE});
    check_damage(*state, &(made){EXR_COMPRESSION_NONE, EXR_PIXEL_HALF, EXR_STORAGE_TILED, 1, 0, TILE});
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_every_storage_is_read, scratch_setup, scratch_teardown),
        cmocka_unit_test(test_steps),
        cmocka_unit_test_setup_teardown(test_other_kinds_are_refused, scratch_setup, scratch_teardown),
        cmocka_unit_test_setup_teardown(test_sides_are_bounded, scratch_setup, scratch_teardown),
        cmocka_unit_test_setup_teardown(test_damage_is_no_crash, scratch_setup, scratch_teardown),
    };
    fill();
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    puts("skipped: this build does not read OpenEXR");
    return 77;
}

#endif
