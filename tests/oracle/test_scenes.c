/* SPDX-License-Identifier: Apache-2.0 */
/* The integer raster against the float64 oracle on real input: every test scene with sensor depth, built at 100 % and
 * at 5 % of its valid points, as stored in the arena and as written to a .ply; and a trained scene from a foreign .ply,
 * where the oracle gets the file's own numbers.
 *
 * Usage: test_scenes TRIM3R DATA_FOLDER; the folder's splits.json shows that the data is there. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "oracle/float64/drawing.h"
#include "oracle/float64/oracle_raster.h"
#include "recording/recording.h"
#include "scene/scene_file.h"

#define LEAST_DB 50.0
enum { SIDE = 256, SKIPPED = 77, PATH_BYTES = 1024 };

static const char *program, *data;
static char folder[PATH_BYTES];

/* ---- comparing ----------------------------------------------------------------------------------- */

static void judge(const char *what, const oracle_gaussian *exact, size_t count, const t3r_scene_frame *frame,
                  const t3r_camera *camera, const drawing *got)
{
    oracle_camera view = oracle_camera_from_t3r(camera, frame, got->width, got->height);
    oracle_image want;
    oracle_render(exact, count, &view, &want);
    double db = oracle_psnr(&want, got->rgb, (size_t)got->width * 3);
    print_message("  %-40s %6zu Gaussians, %6u drawn: %5.1f dB\n", what, count, want.drawn, db);
    oracle_image_free(&want);
    if (db < LEAST_DB) {
        fail_msg("%s: %.1f dB, wanted %.1f", what, db, LEAST_DB);
    }
}

/* ---- scenes with sensor depth -------------------------------------------------------------------- */

static t3r_recording *import_scene(const char *scene)
{
    char path[2 * PATH_BYTES], command[6 * PATH_BYTES], error[256] = "";
    (void)snprintf(path, sizeof path, "%s/%s.mcap", folder, scene);
    (void)snprintf(command, sizeof command, "'%s' import '%s/%s' --size %dx%d -o '%s' >/dev/null", program, data, scene,
                   SIDE, SIDE, path);
    assert_int_equal(system(command), 0);
    t3r_recording *recording = t3r_recording_open(path, error, sizeof error);
    if (recording == NULL) {
        fail_msg("%s", error);
    }
    assert_int_equal(remove(path), 0);
    return recording;
}

static t3r_capture_frame frame_of(const t3r_recording *recording, uint32_t index)
{
    char error[256] = "";
    t3r_capture_frame frame;
    if (t3r_recording_frame(recording, index, &frame, error, sizeof error) != T3R_CAPTURE_FRAME) {
        fail_msg("%s", error);
    }
    return frame;
}

/* Returns the number of pixels with a measured depth in the two context views. */
static uint32_t valid_points(const t3r_recording *recording, t3r_triplet t)
{
    uint32_t valid = 0;
    for (int i = 0; i < 2; i++) {
        t3r_frame frame = frame_of(recording, t.context[i]).frame;
        for (uint32_t y = 0; y < frame.depth_height; y++) {
            const uint8_t *row = frame.depth + (size_t)y * frame.depth_stride_bytes;
            for (uint32_t x = 0; x < frame.depth_width; x++) {
                valid += (row[2 * x] | row[2 * x + 1]) != 0;
            }
        }
    }
    return valid;
}

/* Builds with the budget, draws the target and the first context view, and compares. */
static void check_build(const t3r_recording *recording, const char *scene, t3r_triplet t, uint32_t budget)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, 2, budget);
    arena a = arena_of(&config, ARENA_AT_FULL);
    t3r_runtime *rt = NULL;
    assert_int_equal(t3r_init(&rt, a.bytes, a.count, &config), T3R_OK);
    for (int i = 0; i < 2; i++) {
        t3r_capture_frame frame = frame_of(recording, t.context[i]);
        assert_int_equal(t3r_add_view(rt, &frame.frame, &frame.camera), T3R_OK);
    }
    t3r_scene built;
    assert_int_equal(t3r_reconstruct(rt, NULL, &built), T3R_OK);
    assert_int_equal(built.count, budget);
    oracle_gaussian *exact = calloc(built.count, sizeof *exact);
    assert_non_null(exact);
    for (uint32_t i = 0; i < built.count; i++) {
        oracle_from_t3r(&built.gaussians[i], &exact[i]);
    }
    char path[2 * PATH_BYTES], error[256] = "";
    (void)snprintf(path, sizeof path, "%s/%s.ply", folder, scene);
    if (scene_file_write(path, &built, 0, NULL, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    size_t exported = 0;
    oracle_gaussian *file = oracle_read_ply(path, &built.frame, &exported);
    assert_non_null(file);
    assert_int_equal(exported, built.count);
    assert_int_equal(remove(path), 0);
    const uint32_t views[] = {t.target, t.context[0]};
    for (size_t v = 0; v < 2; v++) {
        t3r_camera camera = frame_of(recording, views[v]).camera;
        camera.distortion = T3R_DISTORTION_NONE;
        drawing d = draw(rt, &camera, SIDE, SIDE);
        char what[64];
        const double percent = 100.0 * built.count / built.valid_points;
        (void)snprintf(what, sizeof what, "frame %u from %u, %u at %.0f %%", views[v], t.context[0], t.context[1],
                       percent);
        judge(what, exact, built.count, &built.frame, &camera, &d);
        (void)snprintf(what, sizeof what, "frame %u from %u, %u at %.0f %%, .ply", views[v], t.context[0], t.context[1],
                       percent);
        judge(what, file, exported, &built.frame, &camera, &d);
        drawing_free(&d);
    }
    free(file);
    free(exact);
    arena_free(&a);
}

static void check_scene(void **state)
{
    const char *scene = *state;
    t3r_recording *recording = import_scene(scene);
    uint32_t triplets = t3r_recording_triplet_count(recording);
    assert_true(triplets > 0);
    /* the first and the last: different distances between the views */
    for (uint32_t i = 0; i<triplets; i += triplets> 1 ? triplets - 1 : 1) {
        t3r_triplet t = t3r_recording_triplet(recording, i);
        if (t.context[0] == t.context[1]) { /* a scene of two frames names one of them twice */
            t.context[0] = 0;
            t.context[1] = 1;
        }
        uint32_t valid = valid_points(recording, t);
        check_build(recording, scene, t, valid);
        check_build(recording, scene, t, (valid + 10) / 20);
    }
    t3r_recording_close(recording);
}

/* ---- a trained scene from a foreign file --------------------------------------------------------- */

static void trained_scene(void **state)
{
    (void)state;
    enum { VIEWS = 8, WIDTH = 480, HEIGHT = 400 };
    char path[2 * PATH_BYTES], error[256] = "";
    (void)snprintf(path, sizeof path, "%s/splats/bulba.ply", data);
    scene_file scene;
    if (scene_file_read(path, 0, &scene, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    size_t count = 0;
    oracle_gaussian *exact = oracle_read_ply(path, &scene.frame, &count);
    assert_non_null(exact);
    assert_int_equal(scene.count, count);
    double middle[3], spread = 0;
    for (int k = 0; k < 3; k++) {
        double sum = 0, squares = 0;
        for (size_t i = 0; i < count; i++) {
            double x =
                ldexp(exact[i].position[k], scene.frame.exponent) + ldexp((double)scene.frame.origin_q32[k], -32);
            sum += x;
            squares += x * x;
        }
        middle[k] = sum / (double)count;
        spread += squares / (double)count - middle[k] * middle[k];
    }
    const double distance = 4 * sqrt(spread);
    t3r_config config = render_config((uint32_t)count, WIDTH, HEIGHT);
    arena a = arena_of(&config, ARENA_AT_FULL);
    t3r_runtime *rt = NULL;
    assert_int_equal(t3r_init(&rt, a.bytes, a.count, &config), T3R_OK);
    load_scene(rt, &scene.frame, scene.gaussians, scene.count);
    for (int v = 0; v < VIEWS; v++) {
        const double turn = 2 * 3.14159265358979 * v / VIEWS;
        const double position[3] = {middle[0] + distance * sin(turn), middle[1] + distance * 0.4 * sin(3 * turn),
                                    middle[2] + distance * cos(turn)};
        t3r_camera camera = camera_towards(600, WIDTH, HEIGHT, position, middle);
        drawing d = draw(rt, &camera, WIDTH, HEIGHT);
        char what[32];
        (void)snprintf(what, sizeof what, "bulba, %d degrees", v * 360 / VIEWS);
        judge(what, exact, count, &scene.frame, &camera, &d);
        drawing_free(&d);
    }
    arena_free(&a);
    free(exact);
    scene_file_free(&scene);
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: %s TRIM3R DATA_FOLDER\n", argv[0]);
        return 2;
    }
    program = argv[1];
    data = argv[2];
    char splits[2 * PATH_BYTES];
    (void)snprintf(splits, sizeof splits, "%s/splits.json", data);
    if (access(splits, R_OK) != 0) {
        printf("SKIPPED: no data in %s\n", data);
        return SKIPPED;
    }
    const char *base = getenv("TMPDIR");
    (void)snprintf(folder, sizeof folder, "%s/trim3r-scenes-XXXXXX", base != NULL ? base : P_tmpdir);
    if (mkdtemp(folder) == NULL) {
        perror(folder);
        return 1;
    }
    static char scenes[][32] = {"hololens_b", "icl_livingroom_synth", "icl_livingroom_noisy_synth", "apc_shelf",
                                "middlebury_teddy"};
    const struct CMUnitTest tests[] = {
        {scenes[0], check_scene, NULL, NULL, scenes[0]}, {scenes[1], check_scene, NULL, NULL, scenes[1]},
        {scenes[2], check_scene, NULL, NULL, scenes[2]}, {scenes[3], check_scene, NULL, NULL, scenes[3]},
        {scenes[4], check_scene, NULL, NULL, scenes[4]}, {"bulba", trained_scene, NULL, NULL, NULL},
    };
    int failed = cmocka_run_group_tests_name("scenes", tests, NULL, NULL);
    (void)rmdir(folder);
    return failed;
}
