/* SPDX-License-Identifier: Apache-2.0 */
/* A runtime that the host library opens: vectors and threads unasked, the same bits, and errors with their reasons. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "state/state.h"
#include "test.h"
#include "trim3r_host.h"

enum { SIDE = 64, VIEWS = 2, GAUSSIANS = 300 };

static uint8_t colour[SIDE][SIDE][3], depth[SIDE][SIDE][2];

/* A leaning wall of chequers, seen from a camera that moves to the right. */
static t3r_status add_views(t3r_runtime *rt)
{
    t3r_camera camera = {.fx_q16 = SIDE << 16, .fy_q16 = SIDE << 16, .rotation_q30 = {1 << 30}};
    const t3r_frame frame = {.format = T3R_PIXEL_RGB24,
                             .width = SIDE,
                             .height = SIDE,
                             .planes = {&colour[0][0][0]},
                             .stride_bytes = {sizeof colour[0]},
                             .depth = &depth[0][0][0],
                             .depth_width = SIDE,
                             .depth_height = SIDE,
                             .depth_stride_bytes = sizeof depth[0],
                             .depth_unit_q40 = 1099511628};
    t3r_status status = T3R_OK;
    camera.cx_q16 = camera.cy_q16 = (SIDE - 1) << 15;
    for (int v = 0; v < VIEWS && status == T3R_OK; v++) {
        for (int i = 0; i < SIDE * SIDE; i++) {
            const int x = i % SIDE, y = i / SIDE, steps = 1500 + 8 * y;
            memset(colour[y][x], ((x + 4 * v) / 8 + y / 8) % 2 == 0 ? 40 : 200, 3);
            depth[y][x][0] = (uint8_t)steps;
            depth[y][x][1] = (uint8_t)(steps >> 8);
        }
        status = t3r_add_view(rt, &frame, &camera);
        camera.position_q32[0] += INT64_C(1) << 29;
    }
    return status;
}

typedef struct heard {
    uint64_t hash;
    uint32_t stages, progress;
} heard;

static void hear_hash(void *user, t3r_stage stage, uint64_t hash)
{
    heard *h = user;
    h->hash = (h->hash ^ hash ^ stage) * UINT64_C(1099511628211);
    h->stages++;
}

static int hear_progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    heard *h = user;
    (void)stage;
    (void)done;
    (void)total;
    h->progress++;
    return 0;
}

static heard build(uint32_t threads)
{
    const t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, GAUSSIANS);
    heard h = {.hash = 0};
    const t3r_hooks hooks = {.user = &h, .progress = hear_progress, .stage_hash = hear_hash};
    char error[256];
    t3r_host *host;
    t3r_scene scene;
    assert_int_equal(t3r_host_open(&host, &config, threads, error, sizeof error), T3R_OK);
    assert_string_equal(error, "");
    assert_int_equal(t3r_host_set_hooks(host, &hooks), T3R_OK);
    assert_int_equal(add_views(t3r_host_runtime(host)), T3R_OK);
    assert_int_equal(t3r_reconstruct(t3r_host_runtime(host), NULL, &scene), T3R_OK);
    assert_int_equal(scene.count, GAUSSIANS);
    t3r_host_close(host);
    return h;
}

TEST(any_number_of_threads_gives_the_same_bits)
{
    const heard one = build(1), three = build(3), all = build(0);
    assert_true(one.stages > 0 && one.progress > 0);
    assert_true(one.hash == three.hash && one.hash == all.hash);
}

TEST(vectors_and_threads_are_taken_unasked)
{
    const t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, GAUSSIANS);
    t3r_host *host, *plain;
    assert_int_equal(t3r_host_open(&host, &config, 0, NULL, 0), T3R_OK);
    assert_int_equal(t3r_host_open(&plain, &config, 2, NULL, 0), T3R_OK);
    t3r_runtime *rt = t3r_host_runtime(host), *other = t3r_host_runtime(plain);
    assert_int_equal(rt->config.workers, t3r_cpu_count());
    assert_int_equal(other->config.workers, 2);
    assert_non_null(other->hooks.parallel_for);
    assert_int_equal(t3r_set_cpu(other, 0), T3R_OK);
    if (t3r_cpu_features() != 0) {
        assert_memory_not_equal(&rt->kernels, &other->kernels, sizeof rt->kernels);
    }
    assert_int_equal(t3r_set_cpu(other, t3r_cpu_features()), T3R_OK);
    assert_memory_equal(&rt->kernels, &other->kernels, sizeof rt->kernels);
    t3r_host_close(plain);
    t3r_host_close(host);
    t3r_host_close(NULL);
}

/* A saved arena goes on with its own number of threads, and the same bits. */
TEST(a_saved_arena_goes_on)
{
    const t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, GAUSSIANS);
    const t3r_hooks none = {0};
    const uint64_t wanted = build(1).hash;
    char error[256];
    t3r_host *host, *again;
    t3r_scene scene;
    size_t bytes;
    assert_int_equal(t3r_host_open(&host, &config, 3, NULL, 0), T3R_OK);
    assert_int_equal(add_views(t3r_host_runtime(host)), T3R_OK);
    const void *arena = t3r_host_arena(host, &bytes);
    uint8_t *saved = malloc(bytes);
    assert_non_null(saved);
    memcpy(saved, arena, bytes);
    t3r_host_close(host);

    heard h = {.hash = 0};
    const t3r_hooks hooks = {.user = &h, .progress = hear_progress, .stage_hash = hear_hash};
    assert_int_equal(t3r_host_attach(&again, saved, bytes, error, sizeof error), T3R_OK);
    assert_string_equal(error, "");
    t3r_runtime *rt = t3r_host_runtime(again);
    assert_int_equal(t3r_get_config(rt)->workers, 3);
    assert_int_equal(t3r_get_cpu(rt), t3r_cpu_features());
    assert_int_equal(t3r_host_set_hooks(again, &hooks), T3R_OK);
    assert_memory_not_equal(&rt->hooks, &none, sizeof none);
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    assert_true(h.hash == wanted);
    t3r_host_close(again);

    assert_int_equal(t3r_host_attach(&again, saved, bytes - 64, error, sizeof error), T3R_ERR_EPOCH);
    assert_null(again);
    assert_non_null(strstr(error, "the arena that was copied has"));
    memset(saved, 0, 64);
    assert_int_equal(t3r_host_attach(&again, saved, bytes, error, sizeof error), T3R_ERR_EPOCH);
    assert_non_null(strstr(error, "arena holds no runtime"));
    assert_int_equal(t3r_host_attach(&again, NULL, bytes, error, sizeof error), T3R_ERR_ARGUMENT);
    assert_string_equal(error, "saved is NULL");
    free(saved);
}

TEST(a_wrong_configuration_is_named)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, GAUSSIANS);
    char error[256];
    t3r_host *host = (t3r_host *)&config;
    config.width = 5000;
    assert_int_equal(t3r_host_open(&host, &config, 0, error, sizeof error), T3R_ERR_CONFIG);
    assert_null(host);
    assert_non_null(strstr(error, "width"));
    config.width = SIDE;
    assert_int_equal(t3r_host_open(&host, &config, T3R_MAX_THREADS + 1, error, sizeof error), T3R_ERR_CONFIG);
    assert_non_null(strstr(error, "workers"));
}

/* A program that was compiled with other headers is refused by each call that takes its structs. */
TEST(another_interface_is_refused)
{
    const t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, GAUSSIANS);
    t3r_program old = t3r_host_program();
    char error[256] = "";
    t3r_host *host;
    old.digest ^= 1;
    old.features &= ~(uint32_t)T3R_HAS_STEREO;
    old.version = "0.1.7";
    assert_int_equal(t3r_host_open_as(old, &host, &config, 0, error, sizeof error), T3R_ERR_INTERFACE);
    assert_null(host);
    assert_string_equal(error,
                        "the program was compiled with other headers than its library's: of trim3r 0.1.7 without "
                        "stereo, and the library is trim3r " T3R_VERSION ": compile it again");
    assert_int_equal(t3r_host_attach_as(old, &host, &config, sizeof config, NULL, 0), T3R_ERR_INTERFACE);
    assert_null(t3r_capture_open_as(old, "replay:none.mcap", NULL, error, sizeof error));
    assert_non_null(strstr(error, "0.1.7"));
    assert_null(t3r_replay_open_as(old, "none.mcap", error, sizeof error));
    assert_non_null(strstr(error, "0.1.7"));

    t3r_recorded_camera camera = {.width = 8, .height = 8};
    const t3r_recorded_camera before = camera;
    const t3r_crop crop = {0, 0, 8, 8};
    const double matrix[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    t3r_camera fixed = {0};
    t3r_scene_file file = {.count = 3};
    const t3r_scene scene = {.count = 0};
    assert_int_equal(t3r_camera_crop_as(old, &camera, &crop, 4, 4, NULL, 0), T3R_ERR_INTERFACE);
    assert_int_equal(t3r_camera_pose_matrix_as(old, &camera, matrix, 0, NULL, 0), T3R_ERR_INTERFACE);
    assert_int_equal(t3r_camera_pose_quaternion_as(old, &camera, matrix, matrix, 0, NULL, 0), T3R_ERR_INTERFACE);
    assert_int_equal(t3r_camera_fixed_as(old, &camera, &fixed, NULL, 0), T3R_ERR_INTERFACE);
    assert_memory_equal(&camera, &before, sizeof camera);
    assert_int_equal(t3r_scene_read_as(old, "none.ply", 0, &file, NULL, 0), T3R_ERR_INTERFACE);
    assert_int_equal(file.count, 3);
    assert_int_equal(t3r_scene_write_as(old, "/dev/null", &scene, 0, NULL, 0), T3R_ERR_INTERFACE);
    assert_int_equal(t3r_scene_load_as(old, NULL, &file, NULL, 0, 0), T3R_ERR_INTERFACE);
}
