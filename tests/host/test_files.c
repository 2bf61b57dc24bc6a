/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes and files of the host library, and pixels of four channels. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "scratch.h"
#include "test.h"
#include "trim3r_host.h"

enum { GAUSSIANS = 5 };

/* Gaussians along a line, of different sizes and colours. */
static t3r_scene line_of(t3r_gaussian *gaussians)
{
    for (int i = 0; i < GAUSSIANS; i++) {
        gaussians[i] = (t3r_gaussian){.position_q20 = {(i - 2) * (1 << 19), i << 16, 3 << 20},
                                      .factor = {[0] = 8192, [4] = 8192, [8] = 4096},
                                      .factor_exponent = -19,
                                      .colour_q7 = {(uint16_t)(6000 * i), 12000, 30000},
                                      .opacity_q15 = (uint16_t)(20000 + 2000 * i),
                                      .confidence = 255};
    }
    return (t3r_scene){.gaussians = gaussians, .count = GAUSSIANS, .frame = {.exponent = 1}};
}

static bool exists(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0;
}

/* Returns the number of files in the folder. */
static int files_in(const char *folder)
{
    DIR *all = opendir(folder);
    int count = 0;
    assert_non_null(all);
    for (struct dirent *entry; (entry = readdir(all)) != NULL;) {
        count += entry->d_name[0] != '.';
    }
    closedir(all);
    return count;
}

TEST_WITH(a_scene_is_read_as_it_was_written, scratch_setup, scratch_teardown)
{
    static const char *const names[] = {"line.ply", "line.compressed.ply", "line.splat", "line.spz", "line.glb"};
    t3r_gaussian gaussians[GAUSSIANS];
    const t3r_scene scene = line_of(gaussians);
    char error[256];
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        const char *path = scratch_path(*state, names[i]);
        t3r_scene_file back;
        assert_int_equal(t3r_scene_write(path, &scene, T3R_SCENE_COMMENTS, error, sizeof error), T3R_OK);
        assert_string_equal(error, "");
        assert_int_equal(t3r_scene_read(path, 0, &back, error, sizeof error), T3R_OK);
        assert_string_equal(error, "");
        assert_int_equal(back.count, GAUSSIANS);
        if (i == 0) { /* its comments hold the frame */
            assert_memory_equal(&back.frame, &scene.frame, sizeof back.frame);
            assert_memory_equal(back.gaussians[4].position_q20, gaussians[4].position_q20,
                                sizeof gaussians[4].position_q20);
        }
        t3r_scene_free(&back);
    }
    assert_int_equal(files_in(((scratch *)*state)->directory), sizeof names / sizeof names[0]);
}

TEST_WITH(a_scene_of_a_file_is_loaded_and_drawn, scratch_setup, scratch_teardown)
{
    enum { SIDE = 32 };
    static uint8_t rgb[SIDE][SIDE][3];
    t3r_gaussian gaussians[GAUSSIANS];
    const t3r_scene scene = line_of(gaussians);
    const char *path = scratch_path(*state, "line.ply");
    const t3r_target view = {SIDE, SIDE, .rgb = &rgb[0][0][0], .rgb_stride_bytes = sizeof rgb[0]};
    const t3r_camera eye = {.width = SIDE,
                            .height = SIDE,
                            .fx_q16 = SIDE << 16,
                            .fy_q16 = SIDE << 16,
                            .cx_q16 = (SIDE - 1) << 15,
                            .cy_q16 = (SIDE - 1) << 15,
                            .rotation_q30 = {1 << 30}};
    t3r_config config = t3r_default_config(SIDE, SIDE, 0, GAUSSIANS);
    t3r_scene_file file;
    t3r_host *host;
    assert_int_equal(t3r_scene_write(path, &scene, 0, NULL, 0), T3R_OK);
    assert_int_equal(t3r_scene_read(path, 0, &file, NULL, 0), T3R_OK);
    assert_int_equal(t3r_host_open(&host, &config, 1, NULL, 0), T3R_OK);
    assert_int_equal(t3r_scene_load(t3r_host_runtime(host), &file, &eye, SIDE, SIDE), T3R_OK);
    assert_int_equal(t3r_render(t3r_host_runtime(host), &eye, &view), T3R_OK);
    assert_true(rgb[SIDE / 2][SIDE / 2][2] > 0);
    assert_int_equal(t3r_scene_load(t3r_host_runtime(host), &file, &eye, SIDE, 2 * SIDE), T3R_ERR_CAMERA);
    t3r_host_close(host);
    /* an arena for fewer Gaussians */
    config = t3r_default_config(SIDE, SIDE, 0, GAUSSIANS - 1);
    assert_int_equal(t3r_host_open(&host, &config, 1, NULL, 0), T3R_OK);
    assert_int_equal(t3r_scene_load(t3r_host_runtime(host), &file, NULL, 0, 0), T3R_ERR_FULL);
    t3r_host_close(host);
    t3r_scene_free(&file);
}

enum { DEGREE = 2, REST = 8 };

/* Arrays of a scene, and floats that point to them. */
typedef struct scene_arrays {
    double positions[GAUSSIANS][3], scales[GAUSSIANS][3], rotations[GAUSSIANS][4], colours[GAUSSIANS][3];
    double opacities[GAUSSIANS];
    float harmonics[GAUSSIANS][REST][3];
} scene_arrays;

static t3r_scene_floats floats_of(scene_arrays *arrays)
{
    return (t3r_scene_floats){.count = GAUSSIANS,
                              .degree = DEGREE,
                              .positions = arrays->positions[0],
                              .scales = arrays->scales[0],
                              .rotations = arrays->rotations[0],
                              .colours = arrays->colours[0],
                              .opacities = arrays->opacities,
                              .harmonics = arrays->harmonics[0][0]};
}

/* Fills arrays with Gaussians along a line. */
static scene_arrays arrays_of_line(void)
{
    scene_arrays arrays = {.positions = {{0}}};
    for (int i = 0; i < GAUSSIANS; i++) {
        const double scales[] = {0.1, 0.05, 0.025};
        for (int axis = 0; axis < 3; axis++) {
            arrays.positions[i][axis] = i * (axis + 1) - 2;
            arrays.scales[i][axis] = scales[axis];
            arrays.colours[i][axis] = 0.2 * i;
        }
        arrays.rotations[i][3] = i + 1; /* half a turn about z, of any length */
        arrays.opacities[i] = 0.15 * (i + 1);
        for (int j = 0; j < 3 * REST; j++) {
            arrays.harmonics[i][j / 3][j % 3] = (float)(j - i) / 64;
        }
    }
    return arrays;
}

static void assert_near(double value, double wanted, double step)
{
    assert_true(value >= wanted - step && value <= wanted + step);
}

TEST_WITH(a_scene_of_floats_is_written_and_comes_back, scratch_setup, scratch_teardown)
{
    const char *path = scratch_path(*state, "floats.glb");
    scene_arrays given = arrays_of_line(), back = {.positions = {{0}}};
    const t3r_scene_floats floats = floats_of(&given);
    t3r_scene_floats found = floats_of(&back);
    t3r_scene_file made, read;
    char error[256] = "?";
    assert_int_equal(t3r_scene_of_floats(&floats, &made, error, sizeof error), T3R_OK);
    assert_string_equal(error, "");
    assert_int_equal(t3r_scene_file_write(path, &made, 0, error, sizeof error), T3R_OK);
    assert_int_equal(t3r_scene_read(path, 0, &read, error, sizeof error), T3R_OK);
    assert_int_equal(t3r_floats_of_scene(&read, &found), T3R_OK);
    for (int i = 0; i < GAUSSIANS; i++) {
        for (int axis = 0; axis < 3; axis++) {
            assert_near(back.positions[i][axis], given.positions[i][axis], 1e-4);
            assert_near(back.colours[i][axis], given.colours[i][axis], 1e-3);
        }
        const double *s = back.scales[i]; /* in any order of the axes */
        assert_near(s[0] + s[1] + s[2], 0.175, 1e-4);
        assert_near(s[0] * s[1] * s[2], 0.000125, 1e-6);
        assert_near(back.opacities[i], given.opacities[i], 1e-3);
        for (int j = 0; j < 3 * REST; j++) {
            assert_near(back.harmonics[i][j / 3][j % 3], given.harmonics[i][j / 3][j % 3], 1e-3);
        }
    }
    found.degree = 3;
    assert_int_equal(t3r_floats_of_scene(&read, &found), T3R_ERR_ARGUMENT);
    found.degree = 0;
    found.harmonics = NULL;
    assert_int_equal(t3r_floats_of_scene(&read, &found), T3R_OK);
    found.count--;
    assert_int_equal(t3r_floats_of_scene(&read, &found), T3R_ERR_ARGUMENT);
    t3r_scene_free(&made);
    t3r_scene_free(&read);
}

TEST(a_float_that_is_wrong_is_named)
{
    scene_arrays given = arrays_of_line();
    t3r_scene_floats floats = floats_of(&given);
    t3r_scene_file made;
    char error[256];
    const struct {
        double *place, value;
        const char *text;
    } rows[] = {
        {&given.positions[3][1], NAN, "positions[3][1] is nan, not a finite number"},
        {&given.scales[4][2], -3, "scales[4][2] is -3, not a standard deviation"},
        {&given.colours[1][0], 255, "colours[1][0] is 255, not about 0 to 1"},
        {&given.opacities[2], 7, "opacities[2] is 7, not 0 to 1: of logits"},
        {&given.rotations[0][3], 0, "rotations[0] is a quaternion without length"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const double before = *rows[i].place;
        *rows[i].place = rows[i].value;
        assert_int_equal(t3r_scene_of_floats(&floats, &made, error, sizeof error), T3R_ERR_ARGUMENT);
        assert_non_null(strstr(error, rows[i].text));
        assert_null(made.gaussians);
        *rows[i].place = before;
    }
    given.harmonics[4][7][1] = INFINITY;
    assert_int_equal(t3r_scene_of_floats(&floats, &made, error, sizeof error), T3R_ERR_ARGUMENT);
    assert_string_equal(error, "harmonics[4][7][1] is inf, not a finite number");
    floats.harmonics = NULL;
    assert_int_equal(t3r_scene_of_floats(&floats, &made, error, sizeof error), T3R_ERR_ARGUMENT);
    assert_string_equal(error, "harmonics are missing for degree 2");
    floats.degree = 4;
    assert_int_equal(t3r_scene_of_floats(&floats, &made, error, sizeof error), T3R_ERR_ARGUMENT);
    assert_string_equal(error, "the degree of the harmonics is 0..3, not 4");
    floats.count = 0;
    assert_int_equal(t3r_scene_of_floats(&floats, &made, error, sizeof error), T3R_ERR_ARGUMENT);
    assert_non_null(strstr(error, "0 Gaussians: a scene has 1.."));
}

TEST_WITH(a_file_that_fails_says_why_and_leaves_the_old_one, scratch_setup, scratch_teardown)
{
    t3r_gaussian gaussians[GAUSSIANS];
    t3r_scene scene = line_of(gaussians);
    t3r_scene_file file;
    char error[256];
    assert_int_equal(t3r_scene_read(scratch_path(*state, "none.ply"), 0, &file, error, sizeof error),
                     T3R_HOST_ERR_FILE);
    assert_non_null(strstr(error, "none.ply: "));
    scratch_write(*state, "bad.ply", "ply\nrubbish", 11);
    assert_int_equal(t3r_scene_read(scratch_path(*state, "bad.ply"), 0, &file, error, sizeof error), T3R_HOST_ERR_FILE);
    assert_non_null(strstr(error, "bad.ply: "));
    assert_int_equal(t3r_scene_write(scratch_path(*state, "line.obj"), &scene, 0, error, sizeof error),
                     T3R_HOST_ERR_FILE);
    assert_non_null(strstr(error, ".spz"));
    scene.count = 0;
    assert_int_equal(t3r_scene_write(scratch_path(*state, "bad.ply"), &scene, 0, error, sizeof error),
                     T3R_HOST_ERR_FILE);
    assert_true(exists(scratch_path(*state, "bad.ply")));
    assert_int_equal(files_in(((scratch *)*state)->directory), 1);
}

/* A scene far from the world's origin is written relative to its own, and the caller hears of it. */
TEST_WITH(what_a_file_cannot_hold_is_said, scratch_setup, scratch_teardown)
{
    t3r_gaussian gaussians[GAUSSIANS];
    t3r_scene scene = line_of(gaussians);
    char error[512];
    scene.frame.origin_q32[0] = INT64_C(1000000) << 32;
    assert_int_equal(t3r_scene_write(scratch_path(*state, "far.splat"), &scene, 0, error, sizeof error), T3R_OK);
    assert_non_null(strstr(error, "far.splat: floats would lose"));
    assert_non_null(strstr(error, "1000000"));
}

TEST_WITH(a_whole_file_replaces_or_leaves, scratch_setup, scratch_teardown)
{
    const char *path = scratch_path(*state, "settings.bin");
    char read[8] = "", error[256];
    assert_int_equal(t3r_write_whole(path, "first", 5, error, sizeof error), T3R_OK);
    assert_int_equal(t3r_write_whole(path, "later", 5, error, sizeof error), T3R_OK);
    assert_string_equal(error, "");
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fread(read, 1, sizeof read, file), 5);
    fclose(file);
    assert_string_equal(read, "later");
    assert_int_equal(files_in(((scratch *)*state)->directory), 1);
    assert_int_equal(t3r_write_whole("/nonexistent/x", "x", 1, error, sizeof error), T3R_HOST_ERR_FILE);
    assert_non_null(strstr(error, "/nonexistent/x: "));
    assert_int_equal(t3r_write_whole("/dev/full", "x", 1, error, sizeof error), T3R_HOST_ERR_FILE);
}
