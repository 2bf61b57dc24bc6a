/* SPDX-License-Identifier: Apache-2.0 */
/* Unusable settings are refused with a reason; the choice of keyframes. */
#include <string.h>

#include "ros/keyframe_map.h"
#include "ros/point_cloud.h"
#include "test.h"

enum { SIDE = 32 };

static uint8_t colour[SIDE][SIDE][3];
static uint8_t depth[SIDE][SIDE][2];

static keyframe_map_settings small(void)
{
    keyframe_map_settings s = keyframe_map_defaults();
    s.width = s.height = SIDE;
    s.gaussians = 100;
    s.head = "analytic";
    s.refine = 0;
    return s;
}

static void refused(keyframe_map_settings s, const char *why)
{
    char error[512] = "";
    assert_null(keyframe_map_open(&s, error, sizeof error));
    if (strstr(error, why) == NULL) {
        fail_msg("\"%s\" does not say \"%s\"", error, why);
    }
}

TEST(settings_are_checked)
{
    keyframe_map_settings s = small();
    s.every = 0;
    refused(s, "every");
    s = small();
    s.overlap_percent = 101;
    refused(s, "overlap");
    s = small();
    s.at_hand = 0;
    refused(s, "at_hand");
    s = small();
    s.threads = T3R_MAX_WORKERS + 1;
    refused(s, "threads");
    s = small();
    s.head = "huge";
    refused(s, "head");
    s = small();
    s.head = "absent.t3w";
    refused(s, "absent.t3w");
    s = small();
    s.gaussians = 0;
    refused(s, "gaussians");
    s = small();
    s.width = 1;
    refused(s, "width");
    s = small();
    s.resume = true;
    refused(s, "state");
    s = small();
    s.snapshot = 1;
    refused(s, "scene");
    s = small();
    s.scene = "scene.txt";
    refused(s, ".ply");
}

/* Feeds six frames of a wall a metre away, seen by a camera that moves `step` millimetres to the right each; returns
 * the number of keyframes. */
static uint32_t keyframes_of(const keyframe_map_settings *s, int step_mm)
{
    char error[512] = "";
    keyframe_map *map = keyframe_map_open(s, error, sizeof error);
    assert_non_null(map);
    assert_true(keyframe_map_arena_bytes(map) > 0);
    t3r_scene scene;
    assert_int_equal(keyframe_map_scene(map, &scene), T3R_ERR_STATE);
    assert_int_equal(keyframe_map_save(map, error, sizeof error), -1);
    assert_non_null(strstr(error, "no scene"));
    for (int i = 0; i < SIDE * SIDE; i++) {
        depth[i / SIDE][i % SIDE][0] = 1000 & 255;
        depth[i / SIDE][i % SIDE][1] = 1000 >> 8;
    }
    const t3r_frame frame = {.format = T3R_PIXEL_RGB24,
                             .width = SIDE,
                             .height = SIDE,
                             .planes = {&colour[0][0][0]},
                             .stride_bytes = {SIDE * 3},
                             .depth = &depth[0][0][0],
                             .depth_width = SIDE,
                             .depth_height = SIDE,
                             .depth_stride_bytes = SIDE * 2,
                             .depth_unit_q40 = 1099511628};
    uint32_t seen = 0;
    for (int i = 0; i < 6; i++) {
        t3r_camera camera = {.fx_q16 = SIDE << 16,
                             .fy_q16 = SIDE << 16,
                             .cx_q16 = (SIDE - 1) << 15,
                             .cy_q16 = (SIDE - 1) << 15,
                             .rotation_q30 = {1 << 30}};
        camera.position_q32[0] = (INT64_C(1) << 32) * i * step_mm / 1000;
        for (int k = 0; k < SIDE * SIDE; k++) { /* checks that stay on the wall */
            const int u = k % SIDE + SIDE * i * step_mm / 1000;
            memset(colour[k / SIDE][k % SIDE], (k / SIDE / 4 + u / 4) % 2 == 0 ? 200 : 50, 3);
        }
        keyframe_map_report report;
        assert_int_equal(keyframe_map_frame(map, i, &frame, &camera, &report, error, sizeof error), T3R_OK);
        assert_string_equal(error, "");
        seen += report.keyframe;
        assert_int_equal(report.taken.keyframes, report.keyframe ? seen : 0);
        assert_true(report.keyframe == (report.hash != 0));
    }
    uint8_t points[100 * POINT_CLOUD_STEP];
    assert_int_equal(keyframe_map_scene(map, &scene), T3R_OK);
    assert_true(scene.count <= 100);
    point_cloud_write(&scene, points);
    keyframe_map_close(map);
    return seen;
}

TEST(keyframes_are_chosen)
{
    keyframe_map_settings s = small();
    assert_int_equal(keyframes_of(&s, 10), 2); /* every third */
    s.every = 1;
    assert_int_equal(keyframes_of(&s, 10), 6);
    s.every = 1000;
    assert_int_equal(keyframes_of(&s, 10), 1);
    s.overlap_percent = 70;
    assert_int_equal(keyframes_of(&s, 0), 1); /* a camera that stands still */
    assert_true(keyframes_of(&s, 200) > 2);
}
