/* SPDX-License-Identifier: Apache-2.0 */
/* Scene files: what is written reads back, and what is not a scene is refused with a reason. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/fixed.h"
#include "scene/gaussian_shape.h"
#include "scene/scene_file.h"
#include "scratch.h"
#include "test.h"

#define COUNT 2000u
#define ROW_FLOATS 17

static const char *path; /* in the test's own folder */

static int make_path(void **state)
{
    int failed = scratch_setup(state);
    path = failed ? NULL : scratch_path(*state, "file.ply");
    return failed;
}

/* White noise in [-most, most]. */
static int noise(uint32_t *seed, int most)
{
    *seed = t3r_mix32(*seed + 0x9e3779b9u);
    return (int)(*seed % (2 * (uint32_t)most + 1)) - most;
}

/* Makes Gaussians of every kind: full, flat, needle-like, no extent at all; all opacities and colours from end to end.
 */
static void make_gaussian(uint32_t index, t3r_gaussian *g)
{
    uint32_t seed = index * 7919;
    *g = (t3r_gaussian){.confidence = 255};
    for (int i = 0; i < 3; i++) {
        g->position_q20[i] = noise(&seed, 8 << 20);
        g->colour_q7[i] = (uint16_t)((noise(&seed, 16320) + 16320) % 32641);
    }
    int columns = (int)(index % 4); /* so many independent directions */
    for (int i = 0; i < 9 && columns > 0; i++) {
        g->factor[i] = (int16_t)(i % 3 < columns ? noise(&seed, 32767) : 0);
    }
    if (index % 8 == 5) { /* one axis a thousand times longer than the others */
        for (int i = 0; i < 9; i++) {
            g->factor[i] = (int16_t)(i % 3 == 0 ? g->factor[i] : noise(&seed, 30));
        }
    }
    g->factor_exponent = (int8_t)(-30 + noise(&seed, 5));
    g->opacity_q15 = (uint16_t)(index < 10   ? index
                                : index < 20 ? 32767 - index + 10
                                             : (uint32_t)(noise(&seed, 16383) + 16383));
}

static void make_scene(t3r_scene *scene, t3r_gaussian *gaussians)
{
    for (uint32_t i = 0; i < COUNT; i++) {
        make_gaussian(i, &gaussians[i]);
    }
    *scene = (t3r_scene){
        .frame = {{(INT64_C(5) << 32) + 12345, -(INT64_C(3) << 31), 77}, 2}, .gaussians = gaussians, .count = COUNT};
}

static double world(const t3r_scene_frame *frame, const t3r_gaussian *g, int axis)
{
    return ldexp((double)frame->origin_q32[axis], -32) + ldexp(g->position_q20[axis], frame->exponent - 20);
}

static void compare(const t3r_gaussian *a, const t3r_scene_frame *fa, const t3r_gaussian *b, const t3r_scene_frame *fb,
                    const double shift[3], uint32_t index)
{
    double p[9], q[9], most = 0, difference = 0;
    gaussian_covariance(a, p);
    gaussian_covariance(b, q);
    for (int i = 0; i < 9; i++) {
        p[i] = ldexp(p[i], 2 * fa->exponent);
        q[i] = ldexp(q[i], 2 * fb->exponent);
        most = fmax(most, fabs(p[i]));
        difference = fmax(difference, fabs(p[i] - q[i]));
    }
    if (difference > 1e-3 * most + 1e-30) {
        fail_msg("Gaussian %u: covariance off by %g of %g", index, difference, most);
    }
    for (int i = 0; i < 3; i++) {
        double off = fabs(world(fa, a, i) - shift[i] - world(fb, b, i));
        if (off > ldexp(1, -16) * ldexp(1, fa->exponent)) {
            fail_msg("Gaussian %u: position off by %g", index, off);
        }
        assert_int_equal(a->colour_q7[i], b->colour_q7[i]);
    }
    if (a->opacity_q15 != b->opacity_q15) {
        fail_msg("Gaussian %u: opacity %u became %u", index, a->opacity_q15, b->opacity_q15);
    }
}

static void round_trip(int flags, const double shift[3], int same_frame)
{
    t3r_gaussian *gaussians = calloc(COUNT, sizeof *gaussians);
    assert_non_null(gaussians);
    t3r_scene scene;
    scene_file back;
    char error[256] = "";
    make_scene(&scene, gaussians);
    assert_int_equal(scene_file_write(path, &scene, flags, NULL, error, sizeof error), 0);
    if (scene_file_read(path, 0, &back, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    assert_int_equal(back.count, COUNT);
    if (same_frame) {
        assert_memory_equal(back.frame.origin_q32, scene.frame.origin_q32, sizeof back.frame.origin_q32);
        assert_int_equal(back.frame.exponent, scene.frame.exponent);
    }
    for (uint32_t i = 0; i < COUNT; i++) {
        compare(&gaussians[i], &scene.frame, &back.gaussians[i], &back.frame, shift, i);
    }
    scene_file_free(&back);
    free(gaussians);
}

TEST(reads_back_what_it_wrote)
{
    const double none[3] = {0}, origin[3] = {5 + 12345 / 4294967296.0, -1.5, 77 / 4294967296.0};
    round_trip(0, none, 0);
    round_trip(T3R_SCENE_COMMENTS, none, 1);
    round_trip(T3R_SCENE_LOCAL, origin, 0);
    round_trip(T3R_SCENE_LOCAL | T3R_SCENE_COMMENTS, none, 1);
}

TEST(decomposes_shapes)
{
    for (uint32_t i = 0; i < COUNT; i++) {
        t3r_gaussian g;
        make_gaussian(i, &g);
        gaussian_shape shape = gaussian_shape_of(&g);
        const double *q = shape.rotation;
        double norm = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        assert_true(fabs(norm - 1) < 1e-12 && q[0] >= 0);
        double largest = fmax(shape.scale[0], fmax(shape.scale[1], shape.scale[2]));
        for (int axis = 0; axis < 3; axis++) {
            assert_true(shape.scale[axis] >= largest * GAUSSIAN_SHAPE_THINNEST && shape.scale[axis] > 0);
        }
        if (i % 4 == 0) {
            assert_true(largest == GAUSSIAN_SHAPE_POINT || i % 8 == 5);
        }
    }
}

/* ---- files that are none ------------------------------------------------------------------------------------ */

static const char header[] =
    "ply\nformat binary_little_endian 1.0\nelement vertex 1\n"
    "property float x\nproperty float y\nproperty float z\n"
    "property float nx\nproperty float ny\nproperty float nz\n"
    "property float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\n"
    "property float opacity\nproperty float scale_0\nproperty float scale_1\nproperty float scale_2\n"
    "property float rot_0\nproperty float rot_1\nproperty float rot_2\nproperty float rot_3\n"
    "end_header\n";
static const float sound_row[ROW_FLOATS] = {1, 2, 3, 0, 0, 0, 0.1f, 0.2f, 0.3f, 0.5f, -3, -4, -5, 1, 0, 0, 0};

/* The floats as the file has them. */
static size_t put_row(uint8_t *out, const float *row, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &row[i], sizeof bits);
        for (int byte = 0; byte < 4; byte++) {
            out[4 * i + (size_t)byte] = (uint8_t)(bits >> (8 * byte));
        }
    }
    return 4 * count;
}

static size_t make_ply(uint8_t *out, const char *text, const float *row)
{
    size_t length = strlen(text);
    memcpy(out, text, length);
    return length + put_row(out + length, row, ROW_FLOATS);
}

static int parse(const uint8_t *bytes, size_t count, char *error, size_t error_bytes)
{
    /* exactly as long as it is, so that a sanitizer sees the byte behind */
    uint8_t *copy = malloc(count + (count == 0));
    assert_non_null(copy);
    memcpy(copy, bytes, count);
    scene_file scene;
    error[0] = '\0';
    int result = scene_file_parse("scene.ply", copy, count, 0, &scene, error, error_bytes);
    assert_int_equal(result != 0, error[0] != '\0');
    if (result != 0) {
        assert_null(scene.gaussians);
    }
    scene_file_free(&scene);
    free(copy);
    return result;
}

TEST(writes_the_expected_header)
{
    t3r_gaussian g;
    make_gaussian(3, &g);
    t3r_scene scene = {.gaussians = &g, .count = 1};
    char error[256] = "";
    uint8_t bytes[1024];
    assert_int_equal(scene_file_write(path, &scene, 0, NULL, error, sizeof error), 0);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t count = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    assert_int_equal(count, strlen(header) + 4 * ROW_FLOATS);
    assert_memory_equal(bytes, header, strlen(header));
    assert_int_equal(scene_file_write("/nonexistent/scene.ply", &scene, 0, NULL, error, sizeof error), -1);
    assert_non_null(strstr(error, "/nonexistent/scene.ply"));
    assert_int_equal(scene_file_write("scene.obj", &scene, 0, NULL, error, sizeof error), -1);
    assert_non_null(strstr(error, "scene.obj: scenes are written as .ply"));
}

TEST(refuses_every_cut)
{
    uint8_t bytes[1024];
    char error[256];
    size_t count = make_ply(bytes, header, sound_row);
    assert_int_equal(parse(bytes, count, error, sizeof error), 0);
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(parse(bytes, i, error, sizeof error), -1);
    }
}

/* The header with one piece replaced by another. */
static void replaced(const char *from, const char *to, char *out, size_t out_bytes)
{
    const char *at = strstr(header, from);
    assert_non_null(at);
    int length = snprintf(out, out_bytes, "%.*s%s%s", (int)(at - header), header, to, at + strlen(from));
    assert_true(length > 0 && (size_t)length < out_bytes);
}

TEST(refuses_foreign_headers)
{
    static const struct {
        const char *from, *to, *reason;
    } bad[] = {
        {"ply\n", "plx\n", "not a .ply"},
        {"binary_little_endian", "ascii", "cut off"},
        {"binary_little_endian", "binary_middle_endian", "are read"},
        {"format binary_little_endian 1.0\n", "", "no format"},
        {"element vertex 1", "element face 1", "no element vertex"},
        {"element vertex 1", "element vertex -1", "no element"},
        {"element vertex 1", "element vertex 1 2", "no element"},
        {"element vertex 1", "element vertex 0", "no Gaussians"},
        {"element vertex 1", "element vertex 2", "cut off"},
        {"element vertex 1", "element vertex 16777216", "cut off"},
        {"element vertex 1", "element vertex 99999999999", "limit"},
        {"element vertex 1", "element chunk 1\nelement vertex 1", "element chunk has no property min_x"},
        {"element vertex 1", "element vertex 1\nelement vertex 1", "second"},
        {"element vertex 1\n", "", "before the first element"},
        {"element vertex 1\n", "element face 9\nproperty list uchar int i\nelement vertex 1\n", "list"},
        {"float x", "quad x", "unknown property type"},
        {"float x", "int x", "not a float"},
        {"float y", "float x", "twice"},
        {"property float opacity\n", "", "opacity is missing"},
        {"rot_3", "rot_4", "rot_3 is missing"},
        {"scale_1", "scale_4", "scale_1 is missing"},
        {"end_header", "and_header", "unknown header line"},
        {"end_header\n", "comment trim3r exponent 99\ncomment trim3r origin_q32 0 0 0\nend_header\n", "exponent"},
        {"end_header\n", "comment trim3r exponent 0\ncomment trim3r origin_q32 9223372036854775807 0 0\nend_header\n",
         "origin"},
        {"end_header\n", "comment trim3r backdrop 2\nend_header\n", "a backdrop of 2 of 1 Gaussians"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char text[1024], error[256];
        uint8_t bytes[2048];
        replaced(bad[i].from, bad[i].to, text, sizeof text);
        size_t count = make_ply(bytes, text, sound_row);
        assert_int_equal(parse(bytes, count, error, sizeof error), -1);
        if (strstr(error, bad[i].reason) == NULL) {
            fail_msg("'%s' does not say '%s'", error, bad[i].reason);
        }
    }
}

TEST(refuses_bad_numbers)
{
    uint8_t bytes[1024];
    char error[256];
    for (int i = 0; i < ROW_FLOATS; i++) {
        int unread = i >= 3 && i < 6;
        int may_be_infinite = i == 9;        /* opacity */
        int may_be_zero = i >= 10 && i < 13; /* scales */
        const struct {
            float value;
            int taken;
        } odd[] = {{NAN, unread},
                   {INFINITY, unread || may_be_infinite},
                   {-INFINITY, unread || may_be_infinite || may_be_zero}};
        for (size_t k = 0; k < sizeof odd / sizeof odd[0]; k++) {
            float row[ROW_FLOATS];
            memcpy(row, sound_row, sizeof row);
            row[i] = odd[k].value;
            size_t count = make_ply(bytes, header, row);
            assert_int_equal(parse(bytes, count, error, sizeof error), odd[k].taken ? 0 : -1);
            if (!odd[k].taken) {
                assert_non_null(strstr(error, "vertex 0"));
            }
        }
    }
    float row[ROW_FLOATS];
    memcpy(row, sound_row, sizeof row);
    row[13] = 0; /* no rotation at all */
    assert_int_equal(parse(bytes, make_ply(bytes, header, row), error, sizeof error), -1);
    memcpy(row, sound_row, sizeof row);
    row[10] = 200; /* e^200 */
    assert_int_equal(parse(bytes, make_ply(bytes, header, row), error, sizeof error), -1);
    memcpy(row, sound_row, sizeof row);
    row[0] = 1e30f;
    assert_int_equal(parse(bytes, make_ply(bytes, header, row), error, sizeof error), -1);
}

/* Other orders, types and company than ours. */
TEST(reads_foreign_layouts)
{
    static const char text[] =
        "ply\r\nformat binary_little_endian 1.0\r\ncomment made elsewhere\r\nobj_info x\r\n"
        "element camera 2\r\nproperty uchar id\r\nproperty double f\r\n"
        "element vertex 1\r\nproperty float opacity\r\nproperty uchar red\r\nproperty float f_rest_0\r\n"
        "property float rot_0\r\nproperty float rot_1\r\nproperty float rot_2\r\nproperty float rot_3\r\n"
        "property float scale_0\r\nproperty float scale_1\r\nproperty float scale_2\r\n"
        "property double x\r\nproperty float y\r\nproperty float z\r\n"
        "property float f_dc_0\r\nproperty float f_dc_1\r\nproperty float f_dc_2\r\n"
        "element face 0\r\nproperty list uchar int vertex_indices\r\nend_header\r\n";
    uint8_t bytes[2048];
    size_t at = strlen(text);
    memcpy(bytes, text, at);
    memset(bytes + at, 0xff, 18); /* the cameras */
    at += 18;
    at += put_row(bytes + at, (float[]){0}, 1);
    bytes[at++] = 200;
    at += put_row(bytes + at, (float[]){9, 0, 0, 0, 2, -1, -1, -1}, 8);
    const uint8_t one[8] = {0, 0, 0, 0, 0, 0, 0xf0, 0x3f};
    memcpy(bytes + at, one, sizeof one);
    at += sizeof one;
    at += put_row(bytes + at, (float[]){2, 3, 10, -10, 0}, 5);
    scene_file scene;
    char error[256] = "";
    if (scene_file_parse("scene.ply", bytes, at, 0, &scene, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    assert_int_equal(scene.count, 1);
    const t3r_gaussian *g = scene.gaussians;
    for (int i = 0; i < 3; i++) {
        assert_true(fabs(world(&scene.frame, g, i) - (i + 1)) < 1e-6);
    }
    assert_int_equal(g->opacity_q15, 16384);
    assert_int_equal(g->colour_q7[0], 32640); /* held at the ends */
    assert_int_equal(g->colour_q7[1], 0);
    assert_int_equal(g->colour_q7[2], 16320);
    scene_file_free(&scene);
}

/* Returns a .ply of rows at the given places. */
static uint8_t *rows_at(const double (*places)[3], uint32_t count, size_t *bytes_count)
{
    char text[1024], element[32];
    snprintf(element, sizeof element, "element vertex %u", count);
    replaced("element vertex 1", element, text, sizeof text);
    uint8_t *bytes = malloc(strlen(text) + (size_t)count * 4 * ROW_FLOATS);
    assert_non_null(bytes);
    size_t at = strlen(text);
    memcpy(bytes, text, at);
    for (uint32_t i = 0; i < count; i++) {
        float row[ROW_FLOATS];
        memcpy(row, sound_row, sizeof row);
        for (int axis = 0; axis < 3; axis++) {
            row[axis] = (float)places[i][axis];
        }
        at += put_row(bytes + at, row, ROW_FLOATS);
    }
    *bytes_count = at;
    return bytes;
}

/* Parses rows at the given places. */
static scene_file scene_at(const double (*places)[3], uint32_t count)
{
    size_t bytes_count;
    scene_file scene;
    char error[256] = "";
    uint8_t *bytes = rows_at(places, count, &bytes_count);
    if (scene_file_parse("scene.ply", bytes, bytes_count, 0, &scene, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    free(bytes);
    return scene;
}

/* Writes a scene whose last Gaussians are a backdrop, and reads it again. */
static int read_with_backdrop(uint32_t backdrop, scene_file *back, char *error, size_t error_bytes)
{
    t3r_gaussian *gaussians = calloc(COUNT, sizeof *gaussians);
    assert_non_null(gaussians);
    t3r_scene scene;
    make_scene(&scene, gaussians);
    for (uint32_t i = COUNT - backdrop; i < COUNT; i++) {
        gaussians[i].view = T3R_NO_VIEW;
    }
    assert_int_equal(scene_file_write(path, &scene, 0, NULL, error, error_bytes), 0);
    free(gaussians);
    return scene_file_read(path, 0, back, error, error_bytes);
}

TEST(the_backdrop_stays_one)
{
    static const uint32_t counts[] = {0, 1, 54, COUNT};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        scene_file back;
        char error[256] = "";
        assert_int_equal(read_with_backdrop(counts[i], &back, error, sizeof error), 0);
        for (uint32_t k = 0; k < COUNT; k++) {
            assert_int_equal(back.gaussians[k].view == T3R_NO_VIEW, k >= COUNT - counts[i]);
        }
        scene_file_free(&back);
    }
}

TEST(a_crop_keeps_what_is_left_of_the_backdrop)
{
    scene_file back;
    scene_conversion counts;
    char error[256] = "";
    assert_int_equal(read_with_backdrop(COUNT / 2, &back, error, sizeof error), 0);
    const scene_crop crop = {.low = {-1e9, -1e9, -1e9}, .high = {1e9, 1e9, 1e9}, .opacity = 0.5};
    uint32_t left = 0;
    for (uint32_t k = COUNT / 2; k < COUNT; k++) {
        left += back.gaussians[k].opacity_q15 >= 16384;
    }
    scene_file_free(&back);
    assert_int_equal(scene_file_convert(path, "cropped.ply", 0, &crop, &counts, error, sizeof error), 0);
    assert_int_equal(scene_file_read("cropped.ply", 0, &back, error, sizeof error), 0);
    uint32_t found = 0;
    for (uint32_t k = 0; k < back.count; k++) {
        found += back.gaussians[k].view == T3R_NO_VIEW;
    }
    assert_true(left > 0 && left < COUNT / 2);
    assert_int_equal(found, left);
    scene_file_free(&back);
    remove("cropped.ply");
}

/* However far a backdrop of most Gaussians is, what is half a unit from a camera amid the others can be drawn: from
 * 1/32 scene unit on. */
TEST(draws_what_is_near_before_a_backdrop)
{
    enum { NEAR = 160, ALL = 400 };
    for (int power = 0, half = 0; power < 11; power += half, half = 1 - half) {
        double places[ALL][3];
        for (uint32_t i = 0; i < ALL; i++) {
            const double turn = i, away = i < NEAR ? 0.2 + 0.8 * i / NEAR : ldexp(1, power);
            places[i][0] = away * cos(turn);
            places[i][1] = away * sin(turn);
            places[i][2] = i < NEAR || half == 0 ? 0.1 * away * (i % 3 - 1.0) : away; /* all around, or on one side */
        }
        scene_file scene = scene_at((const double(*)[3])places, ALL);
        assert_true(ldexp(1, scene.frame.exponent) / 32 <= 0.5);
        assert_int_equal(scene.remarks.pulled, 0);
        for (uint32_t i = 0; i < NEAR; i++) {
            assert_true(fabs(world(&scene.frame, &scene.gaussians[i], 0) - places[i][0]) < 1e-4);
        }
        scene_file_free(&scene);
    }
}

/* Gaussians that lie in one place do not give the scene the size of its farthest one. */
TEST(ignores_gaussians_in_one_place)
{
    enum { PARKED = 60, ALL = 100 };
    double places[ALL][3] = {{0}};
    for (uint32_t i = PARKED; i < ALL; i++) {
        places[i][0] = 1.5 * cos(i);
        places[i][1] = 1.5 * sin(i);
    }
    places[ALL - 1][0] = 1e6;
    scene_file scene = scene_at((const double(*)[3])places, ALL);
    assert_int_equal(scene.frame.exponent, 0);
    assert_int_equal(scene.remarks.pulled, 1);
    for (uint32_t i = 0; i < ALL - 1; i++) {
        assert_true(fabs(world(&scene.frame, &scene.gaussians[i], 0) - places[i][0]) < 1e-6);
    }
    scene_file_free(&scene);
}

/* Whether a .ply of that header, with sound numbers and 0 after them, is read with that remark, as degree 0. */
static void is_remarked(const char *properties, uint32_t extra_bytes, const char *remark)
{
    char text[2048], error[256] = "";
    uint8_t bytes[4096] = {0};
    char before_end[1024];
    snprintf(before_end, sizeof before_end, "%send_header\n", properties);
    replaced("end_header\n", before_end, text, sizeof text);
    const size_t count = make_ply(bytes, text, sound_row) + extra_bytes;
    scene_file scene;
    if (scene_file_parse("scene.ply", bytes, count, 0, &scene, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    assert_string_equal(scene.remarks.text, remark);
    assert_int_equal(scene.degree, 0);
    scene_file_free(&scene);
}

/* Harmonics without one in the middle, or without the first, are those of no degree, and rows that the header does not
 * state are left out: all with a remark. */
TEST(remarks_what_is_left_out)
{
    static const char none[] = "harmonics whose number fits no degree are left out";
    char properties[1024] = "";
    for (int missing = 0; missing < 24; missing += 9) {
        properties[0] = '\0';
        for (int i = 0; i < 24; i++) {
            const size_t length = strlen(properties);
            snprintf(properties + length, sizeof properties - length, "%s f_rest_%d\n",
                     i == missing ? "comment" : "property float", i);
        }
        is_remarked(properties, 23 * sizeof(float), none);
    }
    is_remarked("", 0, "");
    is_remarked("", 4 * ROW_FLOATS - 1, "");
    is_remarked("", 4 * ROW_FLOATS, "rows beyond those that the header states are left out");
}

/* All points at a size of 1 but one far outside: it is moved where it does not fit, and the others keep their places.
 */
TEST(fits_outliers)
{
    enum { POINTS = 100 };
    char text[1024];
    replaced("element vertex 1", "element vertex 100", text, sizeof text);
    uint8_t *bytes = malloc(strlen(text) + POINTS * 4 * ROW_FLOATS);
    assert_non_null(bytes);
    for (int power = 0; power < 24; power++) {
        size_t at = strlen(text);
        memcpy(bytes, text, at);
        float row[ROW_FLOATS];
        for (int i = 0; i < POINTS; i++) {
            memcpy(row, sound_row, sizeof row);
            row[0] = (float)(i % 10) / 10;
            row[1] = (float)(i / 10) / 10;
            row[2] = i == POINTS - 1 ? (float)(1 << power) : 0;
            at += put_row(bytes + at, row, ROW_FLOATS);
        }
        scene_file scene;
        char error[256] = "";
        int result = scene_file_parse("scene.ply", bytes, at, 0, &scene, error, sizeof error);
        if (result != 0) {
            fail_msg("an outlier at 2^%d: %s", power, error);
        }
        assert_int_equal(scene.remarks.pulled, power >= 8);
        for (int i = 0; i < POINTS - 1; i++) {
            assert_true(fabs(world(&scene.frame, &scene.gaussians[i], 0) - i % 10 / 10.0) < 1e-6);
        }
        scene_file_free(&scene);
    }
    free(bytes);
}

ALL_TESTS_WITH(make_path, scratch_teardown)
