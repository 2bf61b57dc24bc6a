/* SPDX-License-Identifier: Apache-2.0 */
#include "motion.h"

#include "core/camera.h"
#include "core/fixed.h"
#include "core/memory.h"
#include "head/head.h"

#define ONE_Q30 (1 << 30)

/* Normalises a checked quaternion: its squared norm is at most 2.25 x 2^60. */
static void normalise(const int32_t q_q30[4], int32_t out_q30[4])
{
    uint64_t norm2_q60 = 0;
    for (int i = 0; i < 4; i++) {
        norm2_q60 += (uint64_t)((int64_t)q_q30[i] * q_q30[i]);
    }
    const int64_t norm_q30 = t3r_isqrt64(norm2_q60);
    for (int i = 0; i < 4; i++) {
        out_q30[i] = (int32_t)t3r_clamp64(t3r_round_div64((int64_t)q_q30[i] * ONE_Q30, norm_q30), -ONE_Q30, ONE_Q30);
    }
}

/* Computes a b of two quaternions of length 1: products are at most 2^60, so sums are at most 2^62. */
static void multiply(const int32_t a[4], const int32_t b[4], int32_t out_q30[4])
{
    static const uint8_t other[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
    static const int8_t sign[4][4] = {{1, -1, -1, -1}, {1, 1, 1, -1}, {1, -1, 1, 1}, {1, 1, -1, 1}};
    int32_t product[4];
    for (int i = 0; i < 4; i++) {
        int64_t sum = 0;
        for (int k = 0; k < 4; k++) {
            sum += sign[i][k] * ((int64_t)a[k] * b[other[i][k]]);
        }
        product[i] = (int32_t)t3r_clamp64(t3r_round_shift64(sum, 30), -ONE_Q30, ONE_Q30);
    }
    normalise(product, out_q30);
}

static bool find_pose(const t3r_camera *camera, const t3r_scene_frame *frame, t3r_pose *pose)
{
    return t3r_camera_check(camera, camera->width, camera->height) == T3R_OK &&
           t3r_pose_in_scene(camera, frame, pose) == T3R_OK;
}

bool t3r_motion_between(const t3r_camera *from, const t3r_camera *to, const t3r_scene_frame *frame, t3r_motion *motion)
{
    t3r_pose pose_from, pose_to;
    int32_t back[4], ahead[4];
    if (!find_pose(from, frame, &pose_from) || !find_pose(to, frame, &pose_to)) {
        return false;
    }
    memcpy(motion->from_q20, pose_from.position_q20, sizeof motion->from_q20);
    memcpy(motion->to_q20, pose_to.position_q20, sizeof motion->to_q20);
    normalise(from->rotation_q30, back);
    normalise(to->rotation_q30, ahead);
    for (int i = 1; i < 4; i++) {
        back[i] = -back[i];
    }
    multiply(ahead, back, motion->quaternion_q30);
    t3r_camera_rotation(motion->quaternion_q30, motion->rotation_q30);
    return true;
}

/* Moves a point: |coordinate| <= 2^30, so offsets are at most 2^31 and sums below 2^63. */
static void move_point(const t3r_motion *motion, const int32_t point_q20[3], int64_t out_q20[3])
{
    for (int i = 0; i < 3; i++) {
        int64_t sum = 0;
        for (int k = 0; k < 3; k++) {
            sum += motion->rotation_q30[3 * i + k] * ((int64_t)point_q20[k] - motion->from_q20[k]);
        }
        out_q20[i] = t3r_round_shift64(sum, 30) + motion->to_q20[i];
    }
}

void t3r_move_camera(const t3r_motion *motion, const t3r_scene_frame *frame, t3r_camera *camera)
{
    const int32_t shift = 12 + frame->exponent; /* from scene units in Q20 to world units in Q32: -12..36 */
    const int64_t most = shift > 0 ? (INT64_C(1) << 61) >> shift : INT64_C(1) << 61;
    int32_t turned[4];
    int64_t moved_q20[3];
    t3r_pose pose;
    if (!find_pose(camera, frame, &pose)) {
        return;
    }
    move_point(motion, pose.position_q20, moved_q20);
    for (int i = 0; i < 3; i++) {
        const int64_t offset_q32 = t3r_scale64(t3r_clamp64(moved_q20[i], -most, most), shift);
        camera->position_q32[i] =
            t3r_clamp64(frame->origin_q32[i] + offset_q32, 1 - T3R_MAX_POSITION_Q32, T3R_MAX_POSITION_Q32 - 1);
    }
    normalise(camera->rotation_q30, turned);
    multiply(motion->quaternion_q30, turned, camera->rotation_q30);
}

/* Turns the factor F of the covariance: R F. */
static void turn(const t3r_motion *motion, t3r_gaussian *g)
{
    int64_t entry_q30[9]; /* below 2^47 */
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            entry_q30[3 * i + j] = 0;
            for (int k = 0; k < 3; k++) {
                entry_q30[3 * i + j] += (int64_t)motion->rotation_q30[3 * i + k] * g->factor[3 * k + j];
            }
        }
    }
    t3r_pack_factor(entry_q30, 30 - g->factor_exponent, g);
}

void t3r_move_map(const t3r_motion *motion, t3r_map *map)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < map->count; i++) {
        int64_t moved_q20[3];
        move_point(motion, map->gaussians[i].position_q20, moved_q20);
        turn(motion, &map->gaussians[i]);
        t3r_map_place(map, i, moved_q20, &kept);
    }
    map->count = kept;
}
