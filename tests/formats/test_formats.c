/* SPDX-License-Identifier: Apache-2.0 */
/* Every format of scene files: written scenes read back within the format's steps; cut and damaged files are refused
 * with a reason. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/fixed.h"
#include "core/little_endian.h"
#include "host/file_bytes.h"
#include "scene/gaussian_shape.h"
#include "scene/scene_file.h"
#include "scene/scene_rows.h"
#include "scene/scene_turn.h"
#include "scratch.h"
#include "test.h"

enum { COUNT = 700, SETS = 300 };

static const struct format {
    const char *suffix;
    double position, scale, colour, opacity, harmonic; /* the most that may differ: scene units, a share, of 1, of 1 */
    uint32_t degree;                                   /* degree that the format keeps */
} formats[] = {
    {".ply", 1e-5, 1e-4, 1e-4, 1e-4, 2e-4, 3}, {".compressed.ply", 4e-3, 2e-2, 3e-3, 3e-3, 0.017, 3},
    {".splat", 1e-5, 3e-2, 3e-3, 3e-3, 0, 0},  {".spz", 1e-5, 4e-2, 5e-3, 3e-3, 0.064, 3},
    {".glb", 1e-5, 1e-3, 1e-4, 1e-4, 2e-4, 3},
#ifdef T3R_WEBP
    {".sog", 5e-4, 3e-2, 5e-3, 3e-3, 0.01, 3},
#endif
};
enum { FORMATS = sizeof formats / sizeof formats[0] };
/* Cuts tried per file, at most. */
enum { TRIED = 1500 };
/* One in FAR_EVERY Gaussians is far away, FAR in all. */
enum { FAR = 3, FAR_EVERY = 100 };

static void *folder;

static int make_folder(void **state)
{
    int failed = scratch_setup(state);
    folder = *state;
    return failed;
}

static double share(uint32_t *seed)
{
    *seed = t3r_mix32(*seed + 0x9e3779b9u);
    return *seed / 4294967296.0;
}

/* Makes a helix, whose x coordinates identify the Gaussians, so that a changed order can be undone. Harmonics are of
 * SETS kinds, since .sog shares them. */
static void make_scene(scene_file *scene, uint32_t degree)
{
    uint32_t seed = 5;
    *scene =
        (scene_file){.frame = {{INT64_C(3) << 30, -(INT64_C(1) << 33), 12345}, 1}, .count = COUNT, .degree = degree};
    scene->gaussians = calloc(COUNT, sizeof *scene->gaussians);
    scene->harmonics_q12 = calloc(COUNT * scene_file_harmonics_count(scene), sizeof(int16_t));
    assert_true(scene->gaussians != NULL && scene->harmonics_q12 != NULL);
    for (uint32_t i = 0; i < COUNT; i++) {
        t3r_gaussian *g = &scene->gaussians[i];
        const double angle = i * 0.05, place[3] = {i * 0.01 - 3.5, cos(angle), sin(angle)};
        double rotation[4], scale[3];
        for (int k = 0; k < 4; k++) {
            rotation[k] = share(&seed) - 0.5;
        }
        for (int k = 0; k < 3; k++) {
            scale[k] = exp(-5 + 2 * share(&seed));
            g->position_q20[k] = (int32_t)nearbyint(ldexp(place[k], 20));
            g->colour_q7[k] = (uint16_t)(share(&seed) * 32640);
        }
        assert_int_equal(gaussian_shape_set(g, scale, rotation), 0);
        g->opacity_q15 = (uint16_t)(1000 + share(&seed) * 31000);
        g->confidence = 255;
        uint32_t set = i % SETS;
        for (size_t k = 0; k < scene_file_harmonics_count(scene); k++) {
            const double value = k < 3 ? (g->colour_q7[k] / 32640.0 - 0.5) / HARMONICS_ZERO : 1.6 * share(&set) - 0.8;
            scene_file_harmonics(scene, i)[k] = (int16_t)nearbyint(value * 4096);
        }
    }
    if (degree == 0) {
        free(scene->harmonics_q12);
        scene->harmonics_q12 = NULL;
    }
}

static double world(const scene_file *scene, uint32_t index, int axis)
{
    return ldexp((double)scene->frame.origin_q32[axis], -32) +
           ldexp(scene->gaussians[index].position_q20[axis], scene->frame.exponent - 20);
}

/* Returns the Gaussian of `b` at the place of Gaussian `index` of `a`. */
static uint32_t find(const scene_file *a, uint32_t index, const scene_file *b)
{
    uint32_t best = 0;
    for (uint32_t i = 1; i < b->count; i++) {
        if (fabs(world(b, i, 0) - world(a, index, 0)) < fabs(world(b, best, 0) - world(a, index, 0))) {
            best = i;
        }
    }
    return best;
}

#define NEAR(x, y, most)                                                                                               \
    do {                                                                                                               \
        if (!(fabs((x) - (y)) <= (most))) {                                                                            \
            fail_msg("%s, Gaussian %u: %s = %g, not %g", f->suffix, index, #x, (double)(x), (double)(y));              \
        }                                                                                                              \
    } while (0)

static void compare(const struct format *f, const scene_file *a, const scene_file *b, uint32_t degree)
{
    assert_int_equal(b->count, a->count);
    assert_int_equal(b->degree, degree < f->degree ? degree : f->degree);
    for (uint32_t index = 0; index < a->count; index++) {
        const uint32_t other = find(a, index, b);
        const t3r_gaussian *g = &a->gaussians[index], *h = &b->gaussians[other];
        double p[9], q[9], most = 0;
        gaussian_covariance(g, p);
        gaussian_covariance(h, q);
        for (int i = 0; i < 9; i++) {
            most = fmax(most, fabs(p[i]));
        }
        for (int i = 0; i < 9; i++) {
            NEAR(ldexp(q[i], 2 * (b->frame.exponent - a->frame.exponent)), p[i], 2.5 * f->scale * most);
        }
        for (int i = 0; i < 3; i++) {
            NEAR(world(b, other, i), world(a, index, i), f->position);
            NEAR(h->colour_q7[i] / 32640.0, g->colour_q7[i] / 32640.0, f->colour);
        }
        NEAR(h->opacity_q15 / 32768.0, g->opacity_q15 / 32768.0, f->opacity);
        for (size_t i = 3; b->degree > 0 && i < scene_file_harmonics_count(b); i++) {
            NEAR(scene_file_harmonics(b, other)[i] / 4096.0, scene_file_harmonics(a, index)[i] / 4096.0, f->harmonic);
        }
    }
}

static const char *path_of(const struct format *f, const char *stem)
{
    char name[64];
    snprintf(name, sizeof name, "%s%s", stem, f->suffix);
    return scratch_path(folder, name);
}

static void must_read(const char *path, scene_file *out)
{
    char error[256] = "";
    if (scene_file_read(path, 0, out, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
}

/* Writes a scene as .ply with doubles, in world coordinates. */
static void write_doubles(const char *path, const scene_file *scene)
{
    static const char *const names[] = {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2"}, *const last[] = {
                                                                                          "opacity", "scale_0",
                                                                                          "scale_1", "scale_2",
                                                                                          "rot_0",   "rot_1",
                                                                                          "rot_2",   "rot_3"};
    const uint32_t rest = harmonics_rest(scene->degree);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file, "ply\nformat binary_little_endian 1.0\nelement vertex %u\n", scene->count);
    for (int i = 0; i < 6; i++) {
        fprintf(file, "property double %s\n", names[i]);
    }
    for (uint32_t i = 0; i < 3 * rest; i++) {
        fprintf(file, "property double f_rest_%u\n", i);
    }
    for (int i = 0; i < 8; i++) {
        fprintf(file, "property double %s\n", last[i]);
    }
    fputs("end_header\n", file);
    const scene_rows rows = scene_rows_of(scene);
    for (uint32_t i = 0; i < scene->count; i++) {
        scene_row row;
        double values[6 + 3 * HARMONICS_REST_MOST + 8];
        uint32_t at = 0;
        assert_int_equal(scene_rows_read(&rows, i, &row, NULL, 0), 0);
        for (int k = 0; k < 3; k++) {
            values[at++] = row.position[k] + ldexp((double)scene->frame.origin_q32[k], -32);
        }
        for (int k = 0; k < 3; k++) {
            values[at++] = row.harmonic[k];
        }
        for (uint32_t k = 0; k < 3 * rest; k++) {
            values[at++] = row.rest[k % rest][k / rest];
        }
        values[at++] = row.opacity_logit;
        memcpy(values + at, row.log_scale, sizeof row.log_scale);
        memcpy(values + at + 3, row.rotation, sizeof row.rotation);
        for (uint32_t k = 0; k < at + 7; k++) {
            uint64_t bits;
            uint8_t bytes[8];
            memcpy(&bits, &values[k], sizeof bits);
            t3r_store_le64(bytes, bits);
            fwrite(bytes, 1, sizeof bytes, file);
        }
    }
    assert_int_equal(fclose(file), 0);
}

static void must_convert(const char *from, const char *to, int flags, scene_conversion *done)
{
    char error[256] = "";
    if (scene_file_convert(from, to, flags, NULL, done, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
}

static void must_write(const char *path, const scene_file *scene, int flags)
{
    scene_conversion done;
    char to[sizeof((scratch){0}.path)];
    snprintf(to, sizeof to, "%s", path); /* which scratch_path() overwrites */
    const char *doubles = scratch_path(folder, "doubles.ply");
    write_doubles(doubles, scene);
    must_convert(doubles, to, flags, &done);
    (void)scratch_path(folder, strrchr(to, '/') + 1);
    assert_int_equal(done.count, scene->count);
}

TEST(read_back)
{
    for (int k = 0; k < FORMATS; k++) {
        for (uint32_t degree = 0; degree <= 3; degree++) {
            scene_file scene, back;
            make_scene(&scene, degree);
            const char *path = path_of(&formats[k], "whole");
            must_write(path, &scene, 0);
            must_read(path, &back);
            compare(&formats[k], &scene, &back, degree);
            scene_file_free(&scene);
            scene_file_free(&back);
        }
    }
}

/* With --up each format has y up; without it, formats with other axes still read as y down. */
TEST(turn_up)
{
    for (int k = 0; k < FORMATS; k++) {
        scene_file scene, back;
        make_scene(&scene, 0);
        const char *path = path_of(&formats[k], "up");
        must_write(path, &scene, SCENE_FILE_UP * T3R_UP_Z);
        must_read(path, &back);
        const bool flipped = strcmp(formats[k].suffix, ".spz") == 0 || strcmp(formats[k].suffix, ".glb") == 0;
        for (uint32_t i = 0; i < COUNT; i += 50) { /* z was up */
            const uint32_t other = strcmp(formats[k].suffix, ".ply") == 0 ? i : find(&scene, i, &back);
            assert_true(fabs((flipped ? -1 : 1) * world(&back, other, 1) - world(&scene, i, 2)) < 0.01);
        }
        scene_file_free(&scene);
        scene_file_free(&back);
    }
}

/* Returns a .glb whose one node is replaced; free() it. */
static uint8_t *with_node(const uint8_t *bytes, size_t count, const char *node, size_t *size)
{
    static const char ours[] = "{\"mesh\":0}";
    const uint32_t text = t3r_load_le32(bytes + 12);
    const char *json = (const char *)bytes + 20, *found = strstr(json, ours);
    assert_non_null(found);
    const size_t before = (size_t)(found - json), longer = strlen(node) - (sizeof ours - 1);
    assert_int_equal(longer % 4, 0);
    uint8_t *out = malloc(count + longer);
    assert_non_null(out);
    memcpy(out, bytes, 20 + before);
    memcpy(out + 20 + before, node, strlen(node));
    memcpy(out + 20 + before + strlen(node), found + sizeof ours - 1, count - 20 - before - (sizeof ours - 1));
    t3r_store_le32(out + 8, (uint32_t)(count + longer));
    t3r_store_le32(out + 12, (uint32_t)(text + longer));
    *size = count + longer;
    return out;
}

/* A node that turns, doubles and moves positions, shapes and harmonics equals the same change made directly. */
TEST(nodes_of_glb)
{
    const struct format doubled = {".glb", 1e-4, 1e-3, 1e-4, 1e-4, 4e-4, 3};
    scene_file scene, moved;
    char error[256] = "";
    size_t count, size;
    make_scene(&scene, 3);
    const char *path = path_of(&doubled, "nodes");
    must_write(path, &scene, 0);
    uint8_t *bytes = t3r_file_bytes(path, SIZE_MAX, &count, error, sizeof error);
    assert_non_null(bytes);
    /* half a turn about y maps x, z to -x, -z in the file's axes and in the scene's, which differ by half a turn about
     * z */
    uint8_t *with = with_node(bytes, count,
                              "{\"mesh\":0,\"rotation\":[0,1,0,0],\"scale\":[2,2,2],\"translation\":[1,2,3 ]}", &size);
    assert_int_equal(scene_file_parse("scene.glb", with, size, 0, &moved, error, sizeof error), 0);
    const double turn[4] = {0, 0, 1, 0}, translation[3] = {-1, -2, 3};
    scene_turn half = scene_turn_of(turn);
    for (uint32_t i = 0; i < COUNT; i++) {
        double rest[HARMONICS_REST_MOST][3], position[3], none[4] = {1, 0, 0, 0}, p[9], q[9];
        for (int k = 0; k < 3; k++) {
            position[k] = world(&scene, i, k);
        }
        for (int k = 0; k < 3 * (int)HARMONICS_REST_MOST; k++) {
            rest[k / 3][k % 3] = scene_file_harmonics(&scene, i)[3 + k] / 4096.0;
        }
        scene_turn_apply(&half, position, none, 3, rest);
        const struct format *f = &doubled;
        const uint32_t index = i;
        for (int k = 0; k < 3; k++) {
            NEAR(world(&moved, i, k), 2 * position[k] + translation[k], f->position);
        }
        for (int k = 0; k < 3 * (int)HARMONICS_REST_MOST; k++) {
            NEAR(scene_file_harmonics(&moved, i)[3 + k] / 4096.0, rest[k / 3][k % 3], f->harmonic);
        }
        gaussian_covariance(&scene.gaussians[i], p);
        gaussian_covariance(&moved.gaussians[i], q);
        for (int k = 0; k < 9; k++) { /* the turn keeps y, and changes the signs of x and z */
            const double sign = (k / 3 == 1) != (k % 3 == 1) ? -1 : 1,
                         units = 2 * (moved.frame.exponent - scene.frame.exponent);
            NEAR(ldexp(q[k], (int)units), 4 * sign * p[k], 1e-2 * 4 * (p[0] + p[4] + p[8]));
        }
    }
    scene_file_free(&scene);
    scene_file_free(&moved);
    free(bytes);
    free(with);
}

static int parse(const char *suffix, const uint8_t *bytes, size_t count, char error[256])
{
    char name[64];
    snprintf(name, sizeof name, "scene%s", suffix);
    /* exactly its length, so that a sanitizer sees a read past the end */
    uint8_t *copy = malloc(count + (count == 0));
    assert_non_null(copy);
    memcpy(copy, bytes, count);
    scene_file scene;
    error[0] = '\0';
    int result = scene_file_parse(name, copy, count, 0, &scene, error, 256);
    assert_int_equal(result != 0, error[0] != '\0');
    if (result != 0) {
        assert_true(scene.gaussians == NULL && scene.harmonics_q12 == NULL);
    }
    scene_file_free(&scene);
    free(copy);
    return result;
}

static uint8_t *bytes_of(const struct format *f, uint32_t count, size_t *size)
{
    scene_file scene;
    char error[256] = "";
    make_scene(&scene, 3);
    scene.count = count;
    const char *path = path_of(f, "small");
    must_write(path, &scene, 0);
    scene_file_free(&scene);
    uint8_t *bytes = t3r_file_bytes(path, SIZE_MAX, size, error, sizeof error);
    assert_non_null(bytes);
    return bytes;
}

TEST(refuse_every_cut)
{
    char error[256];
    for (int k = 0; k < FORMATS; k++) {
        const struct format *f = &formats[k];
        size_t size;
        uint8_t *bytes = bytes_of(f, 3, &size);
        assert_int_equal(parse(f->suffix, bytes, size, error), 0);
        for (size_t cut = 0; cut < size; cut += 1 + size / TRIED) {
            const bool whole_rows = strcmp(f->suffix, ".splat") == 0 && cut > 0 && cut % 32 == 0;
            if (parse(f->suffix, bytes, cut, error) != (whole_rows ? 0 : -1)) {
                fail_msg("%s: cut at byte %zu of %zu", f->suffix, cut, size);
            }
        }
        free(bytes);
    }
}

/* Any changed byte gives a scene or a reason. */
TEST(survive_every_byte)
{
    char error[256];
    for (int k = 0; k < FORMATS; k++) {
        size_t size;
        uint8_t *bytes = bytes_of(&formats[k], 3, &size);
        for (size_t at = 0; at < size; at += 1 + size / TRIED) {
            static const uint8_t values[] = {0, 1, 0x7f, 0x80, 0xff};
            const uint8_t kept = bytes[at];
            for (size_t i = 0; i < sizeof values; i++) {
                bytes[at] = values[i];
                (void)parse(formats[k].suffix, bytes, size, error);
            }
            bytes[at] = kept;
        }
        free(bytes);
    }
}

TEST(say_why)
{
    static const struct {
        const char *suffix, *reason;
        size_t at;
        uint8_t value;
    } bad[] = {
        {".spz", "not an .spz file", 0, 'X'},
        {".spz", "version 9", 4, 9},
        {".spz", "are read from", 11, 1},
        {".spz", "harmonics of degree 5", 12, 5},
        {".spz", "255 fraction bits", 13, 255},
        {".spz", "2 streams", 15, 2},
        {".spz", "table at byte 255", 16, 255},
        {".spz", "cut off", 34, 255},
        {".glb", "not a .glb", 4, 1},
        {".glb", "chunk of JSON", 16, 1},
        {".glb", "not JSON", 20, 'x'},
        {".glb", "cut off", 14, 255},
        {".splat", "not finite", 3, 0x7f},
        {".splat", "below 0", 15, 0xbf},
        {".compressed.ply", "property", 70, 'w'},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        int k = 0;
        while (strcmp(formats[k].suffix, bad[i].suffix) != 0) {
            k++;
        }
        size_t size;
        char error[256];
        uint8_t *bytes = bytes_of(&formats[k], 3, &size);
        bytes[bad[i].at] = bad[i].value;
        if (strcmp(bad[i].suffix, ".splat") == 0 && bad[i].at == 3) {
            bytes[2] = 0x80;
        }
        assert_int_equal(parse(bad[i].suffix, bytes, size, error), -1);
        if (strstr(error, bad[i].reason) == NULL) {
            fail_msg("%s: '%s' does not say '%s'", bad[i].suffix, error, bad[i].reason);
        }
        free(bytes);
    }
}

/* Moves a few Gaussians of a scene to a million times the distance of the others, and writes it as write_doubles(). */
static void write_with_far(const char *path, const scene_file *scene)
{
    char error[256] = "";
    size_t count;
    write_doubles(path, scene);
    uint8_t *bytes = t3r_file_bytes(path, SIZE_MAX, &count, error, sizeof error);
    assert_non_null(bytes);
    const size_t row_bytes = (6 + 3 * (size_t)harmonics_rest(scene->degree) + 8) * sizeof(double);
    uint8_t *rows = bytes + count - scene->count * row_bytes;
    for (uint32_t i = 0; i < FAR; i++) {
        const double x = 1e6 * (i + 1); /* on a little-endian machine */
        memcpy(rows + i * FAR_EVERY * row_bytes, &x, sizeof x);
    }
    assert_int_equal(scratch_write(folder, strrchr(path, '/') + 1, bytes, count), 0);
    free(bytes);
}

/* Gaussians far away do not change where the others are, in any format. */
TEST(far_gaussians)
{
    for (int k = 0; k < FORMATS; k++) {
        const struct format *f = &formats[k];
        scene_file scene, back;
        scene_conversion done;
        char from[sizeof((scratch){0}.path)];
        make_scene(&scene, 3);
        snprintf(from, sizeof from, "%s", scratch_path(folder, "doubles.ply"));
        write_with_far(from, &scene);
        const char *path = path_of(f, "far");
        must_convert(from, path, 0, &done);
        must_read(path, &back);
        const bool keeps =
            strcmp(f->suffix, ".ply") == 0 || strcmp(f->suffix, ".splat") == 0 || strcmp(f->suffix, ".glb") == 0;
        assert_int_equal(back.count, keeps ? COUNT : COUNT - FAR);
        for (uint32_t index = 0; index < COUNT; index++) {
            const uint32_t other = find(&scene, index, &back);
            for (int axis = 0; axis < 3 && index % FAR_EVERY != 0; axis++) {
                NEAR(world(&back, other, axis), world(&scene, index, axis), f->position);
            }
        }
        scene_file_free(&scene);
        scene_file_free(&back);
    }
}

static double height_of(const scene_file *scene)
{
    double low = world(scene, 0, 1), high = low;
    for (uint32_t i = 1; i < scene->count; i++) {
        low = fmin(low, world(scene, i, 1));
        high = fmax(high, world(scene, i, 1));
    }
    return high - low;
}

/* A scene whose place floats resolve to a half keeps its detail; formats with an origin keep its place, too. */
TEST(far_from_the_origin)
{
    for (int k = 0; k < FORMATS; k++) {
        const struct format *f = &formats[k];
        scene_file scene, back;
        make_scene(&scene, 0);
        for (int axis = 0; axis < 3; axis++) {
            scene.frame.origin_q32[axis] += (axis + 1) * (INT64_C(4700000) << 32);
        }
        const char *path = path_of(f, "utm");
        must_write(path, &scene, 0);
        must_read(path, &back);
        const bool has_origin = strcmp(f->suffix, ".ply") == 0 || strcmp(f->suffix, ".glb") == 0;
        for (uint32_t index = 0; index < COUNT && has_origin; index++) {
            for (int axis = 0; axis < 3; axis++) {
                NEAR(world(&back, index, axis), world(&scene, index, axis), f->position);
            }
        }
        assert_true(fabs(height_of(&back) - height_of(&scene)) < 1e-2);
        scene_file_free(&scene);
        scene_file_free(&back);
    }
}

/* A scene wider than the format holds. */
TEST(refuse_to_write)
{
    char error[256] = "";
    t3r_gaussian g = {.position_q20 = {1000 << 20, 0, 0}, .opacity_q15 = 9};
    const t3r_scene wide = {.frame = {.exponent = 24}, .gaussians = &g, .count = 1};
    assert_int_equal(scene_file_write(scratch_path(folder, "wide.spz"), &wide, 0, NULL, error, sizeof error), -1);
    assert_non_null(strstr(error, "outside 2^-24..2^24"));
}

ALL_TESTS_WITH(make_folder, scratch_teardown)
