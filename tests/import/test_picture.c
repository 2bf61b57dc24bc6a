/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures: written ones are read back, damaged ones are refused. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include <jpeglib.h>
#include <png.h>

#include "pictures/heif_references.h"
#include "pictures/picture.h"
#include "scratch.h"
#include "test.h"

static void fill(uint8_t *bytes, size_t count)
{
    uint32_t x = 12345;
    for (size_t i = 0; i < count; i++) {
        x = x * 1664525u + 1013904223u;
        bytes[i] = (uint8_t)(x >> 24);
    }
}

static void check_round_trip(scratch *s, uint32_t width, uint32_t height, uint32_t channels, uint32_t bits)
{
    char error[256];
    size_t bytes = (size_t)width * height * channels * bits / 8;
    picture out = {.width = width, .height = height, .channels = channels, .bits = bits, .samples = malloc(bytes)}, in;
    uint32_t sides[2];
    fill(out.samples, bytes);
    assert_int_equal(picture_write_png(scratch_path(s, "a.png"), &out, error, sizeof error), 0);
    assert_int_equal(picture_read(s->path, &in, error, sizeof error), 0);
    assert_int_equal(in.width, width);
    assert_int_equal(in.height, height);
    assert_int_equal(in.channels, channels);
    assert_int_equal(in.bits, bits);
    assert_memory_equal(in.samples, out.samples, bytes);
    assert_int_equal(picture_size(s->path, &sides[0], &sides[1], error, sizeof error), 0);
    assert_int_equal(sides[0], width);
    assert_int_equal(sides[1], height);
    picture_free(&in);
    picture_free(&out);
}

TEST(test_png_round_trips)
{
    check_round_trip(*state, 37, 11, 3, 8);
    check_round_trip(*state, 1, 1, 1, 8);
    check_round_trip(*state, 64, 5, 1, 16);
}

/* Writes a PNG with libpng in another pixel format. */
static void write_foreign_png(const char *path, int colour_type, int bits)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    const png_color palette[2] = {{10, 20, 30}, {200, 100, 50}};
    png_byte row[8] = {1, 0, 1, 0, 1, 0, 1, 0};
    if (setjmp(png_jmpbuf(png))) {
        fail_msg("libpng refused to write");
    }
    png_init_io(png, file);
    png_set_IHDR(png, info, 2, 1, bits, colour_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (colour_type == PNG_COLOR_TYPE_PALETTE) {
        png_set_PLTE(png, info, palette, 2);
    }
    png_write_info(png, info);
    png_write_row(png, row);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    fclose(file);
}

TEST(test_foreign_png_formats_become_8_bit)
{
    scratch *s = *state;
    char error[256];
    picture in;
    write_foreign_png(scratch_path(s, "p.png"), PNG_COLOR_TYPE_PALETTE, 8);
    assert_int_equal(picture_read(s->path, &in, error, sizeof error), 0);
    static const uint8_t expected[6] = {200, 100, 50, 10, 20, 30};
    assert_int_equal(in.channels * in.bits, 24);
    assert_memory_equal(in.samples, expected, sizeof expected);
    picture_free(&in);
    write_foreign_png(scratch_path(s, "a.png"), PNG_COLOR_TYPE_RGB_ALPHA, 8);
    assert_int_equal(picture_read(s->path, &in, error, sizeof error), 0);
    static const uint8_t without_alpha[6] = {1, 0, 1, 1, 0, 1};
    assert_memory_equal(in.samples, without_alpha, sizeof without_alpha);
    picture_free(&in);
}

static size_t file_bytes(const char *path, uint8_t **bytes)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    *bytes = malloc(1 << 20);
    size_t count = fread(*bytes, 1, 1 << 20, file);
    fclose(file);
    return count;
}

/* Every shorter file is refused with the path in the message. */
static void refuse_all_cuts(scratch *s, const char *name)
{
    uint8_t *bytes;
    size_t count = file_bytes(scratch_path(s, name), &bytes);
    assert_true(count > 100);
    for (size_t cut = 0; cut + 3 <= count; cut += cut < 64 ? 1 : 13) {
        char error[256] = "";
        picture in;
        assert_int_equal(scratch_write(s, "cut", bytes, cut), 0);
        assert_int_equal(picture_read(s->path, &in, error, sizeof error), -1);
        assert_non_null(strstr(error, s->path));
        assert_null(in.samples);
    }
    free(bytes);
}

static void write_jpeg_as(const char *path, uint32_t width, uint32_t height, bool progressive, int inks)
{
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr manager;
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    jpeg.err = jpeg_std_error(&manager);
    jpeg_create_compress(&jpeg);
    jpeg_stdio_dest(&jpeg, file);
    jpeg.image_width = width;
    jpeg.image_height = height;
    jpeg.input_components = inks;
    jpeg.in_color_space = inks == 4 ? JCS_CMYK : JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 95, TRUE);
    if (progressive) {
        jpeg_simple_progression(&jpeg);
    }
    jpeg_start_compress(&jpeg, TRUE);
    uint8_t *row = calloc(width, (size_t)inks);
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            row[3 * x] = (uint8_t)(x * 3);
            row[3 * x + 1] = (uint8_t)(y * 3);
            row[3 * x + 2] = 128;
        }
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    free(row);
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    fclose(file);
}

static void write_jpeg(const char *path, uint32_t width, uint32_t height)
{
    write_jpeg_as(path, width, height, false, 3);
}

/* Checks that a JPEG without its end marker is read as with it, and that nothing more may be lacking: no byte of a
 * scan, and no scan. */
TEST(test_the_end_marker_may_be_missing)
{
    scratch *s = *state;
    for (int progressive = 0; progressive < 2; progressive++) {
        uint8_t *bytes;
        char error[256] = "";
        picture whole, in;
        write_jpeg_as(scratch_path(s, "a.jpg"), 80, 60, progressive != 0, 3);
        assert_int_equal(picture_read(s->path, &whole, error, sizeof error), 0);
        const size_t count = file_bytes(s->path, &bytes);
        for (size_t lacking = 1; lacking < count - 1; lacking += lacking < 40 ? 1 : 29) {
            assert_int_equal(scratch_write(s, "cut.jpg", bytes, count - lacking), 0);
            const int status = picture_read(s->path, &in, error, sizeof error);
            assert_int_equal(status, lacking <= 2 ? 0 : -1);
            if (status == 0) {
                assert_memory_equal(in.samples, whole.samples, (size_t)80 * 60 * 3);
            }
            picture_free(&in);
        }
        picture_free(&whole);
        free(bytes);
    }
}

TEST(test_jpeg_is_read)
{
    scratch *s = *state;
    char error[256];
    picture in;
    uint32_t sides[2];
    write_jpeg(scratch_path(s, "a.jpg"), 80, 60);
    assert_int_equal(picture_size(s->path, &sides[0], &sides[1], error, sizeof error), 0);
    assert_int_equal(sides[0], 80);
    assert_int_equal(sides[1], 60);
    assert_int_equal(picture_read(s->path, &in, error, sizeof error), 0);
    assert_int_equal(in.width, 80);
    assert_int_equal(in.height, 60);
    assert_int_equal(in.channels, 3);
    const uint8_t *pixel = (const uint8_t *)in.samples + ((size_t)40 * 80 + 50) * 3;
    assert_in_range(pixel[0], 144, 156);
    assert_in_range(pixel[1], 114, 126);
    assert_in_range(pixel[2], 122, 134);
    picture_free(&in);
}

TEST(test_cut_files_are_refused)
{
    scratch *s = *state;
    check_round_trip(s, 40, 30, 3, 8);
    refuse_all_cuts(s, "a.png");
    check_round_trip(s, 40, 30, 1, 16);
    refuse_all_cuts(s, "a.png");
    write_jpeg(scratch_path(s, "a.jpg"), 80, 60);
    refuse_all_cuts(s, "a.jpg");
}

static void expect_refused(const char *path, const char *why)
{
    char error[256] = "";
    picture in;
    assert_int_equal(picture_read(path, &in, error, sizeof error), -1);
    if (strstr(error, why) == NULL) {
        fail_msg("'%s' does not say '%s'", error, why);
    }
}

TEST(test_bad_files_are_named)
{
    scratch *s = *state;
    expect_refused(scratch_path(s, "missing.png"), "missing.png: No such file");
    assert_int_equal(scratch_write(s, "text.png", "hello, world", 12), 0);
    expect_refused(s->path, "neither PNG nor JPEG");
    assert_int_equal(scratch_write(s, "empty.png", "", 0), 0);
    expect_refused(s->path, "empty");
    /* one byte of the compressed data changed: the checksum detects it */
    uint8_t *bytes;
    check_round_trip(s, 40, 30, 3, 8);
    size_t count = file_bytes(scratch_path(s, "a.png"), &bytes);
    bytes[count / 2] ^= 0x55;
    assert_int_equal(scratch_write(s, "flip.png", bytes, count), 0);
    expect_refused(s->path, "PNG: ");
    free(bytes);
}

TEST(test_sizes_over_the_limit_are_refused)
{
    scratch *s = *state;
    char error[256];
    picture wide = {.width = 4097, .height = 1, .channels = 1, .bits = 8, .samples = calloc(4097, 1)};
    assert_int_equal(picture_write_png(scratch_path(s, "wide.png"), &wide, error, sizeof error), 0);
    expect_refused(s->path, "PNG: ");
    picture_free(&wide);
    write_jpeg(scratch_path(s, "wide.jpg"), 4097, 1);
    expect_refused(s->path, "largest size");
}

TEST(test_writing_fails_cleanly)
{
    scratch *s = *state;
    char error[256] = "";
    uint8_t samples[3] = {0};
    picture p = {.width = 1, .height = 1, .channels = 3, .bits = 8, .samples = samples}, odd = p;
    odd.channels = 2;
    assert_int_equal(picture_write_png(scratch_path(s, "no/such/folder.png"), &p, error, sizeof error), -1);
    assert_non_null(strstr(error, "folder.png: No such file"));
    assert_int_equal(picture_write_png(scratch_path(s, "odd.png"), &odd, error, sizeof error), -1);
    /* a full disk: no file grows beyond 16 bytes */
    struct rlimit before, full;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    full = (struct rlimit){16, before.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &full), 0);
    int status = picture_write_png(scratch_path(s, "full.png"), &p, error, sizeof error);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(status, -1);
    assert_non_null(strstr(error, "full.png: "));
    assert_int_not_equal(access(s->path, F_OK), 0);
    /* a device is written to and not replaced */
    assert_int_equal(picture_write_png("/dev/null", &p, error, sizeof error), 0);
    assert_int_equal(access("/dev/null", W_OK), 0);
}

TEST(refuses_four_inks)
{
    picture in;
    char error[256] = "";
    write_jpeg_as(scratch_path(*state, "a.jpg"), 16, 8, false, 4);
    assert_int_equal(picture_read(((scratch *)*state)->path, &in, error, sizeof error), -1);
    assert_non_null(strstr(error, "CMYK"));
    assert_non_null(strstr(error, "convert IN.jpg"));
    assert_null(in.samples);
}

/* Puts a box's size and type before its content of so many bytes; returns the bytes of both. */
static size_t put_box(uint8_t *at, const char *type, size_t content)
{
    const size_t size = 8 + content;
    memmove(at + 8, at, content);
    for (int i = 0; i < 4; i++) {
        at[i] = (uint8_t)(size >> (24 - 8 * i));
        at[4 + i] = (uint8_t)type[i];
    }
    return size;
}

/* Makes a file of references from one picture to another, whose numbers have 2 bytes, or 4. */
static size_t make_references(uint8_t *out, const char *type, const uint32_t (*pairs)[2], uint32_t count, bool wide)
{
    const size_t id_bytes = wide ? 4 : 2;
    size_t at = 4;
    memset(out, 0, at);
    out[0] = wide; /* version */
    for (uint32_t i = 0; i < count; i++) {
        uint8_t *one = out + at;
        memset(one, 0, 2 * id_bytes + 2);
        one[id_bytes - 1] = (uint8_t)pairs[i][0];
        one[id_bytes + 1] = 1;
        one[2 * id_bytes + 1] = (uint8_t)pairs[i][1];
        at += put_box(one, type, 2 * id_bytes + 2);
    }
    at = put_box(out, "iref", at);
    memmove(out + 4, out, at);
    memset(out, 0, 4); /* version and flags of meta */
    return put_box(out, "meta", 4 + at);
}

/* A picture of HEIC may consist of tiles and have an alpha, but not of itself, in however many steps. */
TEST(refuses_pictures_of_themselves)
{
    static const uint32_t tiles[][2] = {{1, 2}, {1, 3}, {1, 3}, {4, 1}}, itself[][2] = {{7, 7}},
                          each_other[][2] = {{1, 2}, {2, 1}};
    uint32_t chain[HEIF_DEPTH_MOST + 1][2], many[HEIF_REFERENCES_MOST + 1][2];
    for (uint32_t i = 0; i <= HEIF_DEPTH_MOST; i++) {
        chain[i][0] = i;
        chain[i][1] = i + 1;
    }
    for (uint32_t i = 0; i <= HEIF_REFERENCES_MOST; i++) {
        many[i][0] = 1;
        many[i][1] = 2;
    }
    const struct {
        const char *type;
        const uint32_t (*pairs)[2];
        uint32_t count;
        const char *wrong; /* NULL: nothing */
    } cases[] = {{"dimg", tiles, 4, NULL},
                 {"auxl", tiles, 4, NULL},
                 {"thmb", itself, 1, NULL},
                 {"dimg", itself, 1, "of itself"},
                 {"auxl", itself, 1, "of itself"},
                 {"dimg", each_other, 2, "of itself"},
                 {"dimg", (const uint32_t(*)[2])chain, HEIF_DEPTH_MOST, NULL},
                 {"dimg", (const uint32_t(*)[2])chain, HEIF_DEPTH_MOST + 1, "of itself"},
                 {"dimg", (const uint32_t(*)[2])many, HEIF_REFERENCES_MOST, NULL},
                 {"dimg", (const uint32_t(*)[2])many, HEIF_REFERENCES_MOST + 1, "references"}};
    uint8_t *bytes = malloc(32 * (HEIF_REFERENCES_MOST + 2));
    assert_non_null(bytes);
    for (size_t i = 0; i < 2 * sizeof cases / sizeof cases[0]; i++) {
        const size_t count =
            make_references(bytes, cases[i / 2].type, cases[i / 2].pairs, cases[i / 2].count, i % 2 != 0);
        const char *wrong = heif_references_check(bytes, count);
        if (cases[i / 2].wrong == NULL ? wrong != NULL : wrong == NULL || strstr(wrong, cases[i / 2].wrong) == NULL) {
            fail_msg("case %zu: %s", i / 2, wrong);
        }
        for (size_t cut = 0; cut < count && count < 1000; cut++) {
            (void)heif_references_check(bytes, cut);
        }
    }
    free(bytes);
}

ALL_TESTS_WITH(scratch_setup, scratch_teardown)
