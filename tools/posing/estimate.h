/* SPDX-License-Identifier: Apache-2.0 */
/* Poses of any number of views: each from the best one that has its pose already. */
#ifndef TRIM3R_TOOLS_POSING_ESTIMATE_H
#define TRIM3R_TOOLS_POSING_ESTIMATE_H

#include <stddef.h>

#include "geometry/rigid.h"
#include "posing/poses_source.h"
#include "posing/view.h"

#define POSES_MOST 1000u
#define POSES_WINDOW 16u /* views further apart in their order are not compared */

#define POSES_WHY_BYTES 256

/* Evidence of an estimate, or the reason why there is none. */
typedef struct pose_account {
    char why[POSES_WHY_BYTES];              /* why the view has no pose; "" = it has one */
    uint32_t from;                          /* the view that it was made from, or could not be; its own number: none */
    uint32_t matches, tried;                /* features that agree with the motion, of those that match */
    bool metric;                            /* by depth in both */
    double pixels;                          /* root of the mean square of their errors */
    double turn_degrees, direction_degrees; /* standard deviations to expect of the motion between the two */
} pose_account;

/* Whether so many views are posed at once: to be asked before pictures are decoded. 0, or -1 with a reason in error[].
 */
int poses_check_count(uint32_t count, char *error, size_t error_bytes);

/* Poses of the views that can be joined, camera to the first camera that has one: the first view, or the first after it
 * to which another can be joined. The others' accounts say why. The unit of length is that of the depths; without any,
 * the distance of the first two cameras that are joined. views[] gain the depths of features found on the way.
 * Deterministic: fixed seeds, bounded work. 0, or -1 with "frame N: why" in error[], N as `names` has it (NULL: the
 * index), where no two of several views can be joined. */
int poses_estimate(pose_view *views, uint32_t count, poses_source source, const uint32_t *names, rigid *poses,
                   pose_account *accounts, char *error, size_t error_bytes);

/* "frame N cannot be posed from frame M: why", of a view without a pose, into text[]. Always -1, as t3r_reason(). */
int pose_refusal(const pose_account *accounts, uint32_t index, const uint32_t *names, char *text, size_t bytes);
/* The first view that has a pose, or that has none, at `from` or behind; `count` when there is no such one. */
uint32_t poses_find(const pose_account *accounts, uint32_t from, uint32_t count, bool posed);

/* The pose `pose` in the first camera's axes, behind the first camera's own pose in `first`, rounded to the fixed point
 * of t3r_camera into `camera`: positions to Q32, the quaternion to Q30. -1 when a position is out of range. */
int pose_store(const rigid *pose, const t3r_camera *first, t3r_camera *camera);

#endif
