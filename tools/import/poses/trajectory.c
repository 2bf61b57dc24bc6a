/* SPDX-License-Identifier: Apache-2.0 */
#include "import/poses/trajectory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geometry/pose_check.h"
#include "geometry/quaternion.h"
#include "host/file_bytes.h"
#include "host/grow.h"
#include "host/reason.h"
#include "import/poses/pose_list.h"
#include "mcap/mcap_records.h"
#include "mcap/reader_limits.h"
#include "recording/recording.h"
#include "recording/recording_folder.h"

void trajectory_free(trajectory *t)
{
    free(t->poses);
    *t = (trajectory){0};
}

static int by_stamp(const void *a, const void *b)
{
    const trajectory_pose *x = a, *y = b;
    return x->stamp_ns != y->stamp_ns ? (x->stamp_ns > y->stamp_ns) - (x->stamp_ns < y->stamp_ns)
                                      : (x->order > y->order) - (x->order < y->order);
}

/* Returns NULL, or why it cannot be appended. */
static const char *append(trajectory *t, size_t *room, const trajectory_pose *pose)
{
    if (t->count == T3R_LIMIT_POSES) {
        return T3R_LIMIT_TEXT("more than ", T3R_LIMIT_POSES, " poses");
    }
    trajectory_pose *grown = t3r_grow(t->poses, t->count, room, sizeof *grown);
    if (grown == NULL) {
        return "out of memory";
    }
    t->poses = grown;
    t->poses[t->count] = *pose;
    t->poses[t->count].order = t->count;
    t->count++;
    return NULL;
}

/* Sorts by stamp; of equal stamps the first stays. Repeated poses that are equal are no loss. */
static void order(trajectory *t)
{
    size_t kept = 0;
    qsort(t->poses, t->count, sizeof *t->poses, by_stamp);
    for (size_t i = 0; i < t->count; i++) {
        const trajectory_pose *pose = &t->poses[i], *last = kept > 0 ? &t->poses[kept - 1] : NULL;
        if (last == NULL || pose->stamp_ns != last->stamp_ns) {
            t->poses[kept++] = *pose;
        } else if (memcmp(&pose->pose, &last->pose, sizeof pose->pose) != 0) {
            pose_losses_add_repeated(&t->losses, (double)pose->stamp_ns * 1e-9);
        }
    }
    t->count = kept;
}

int trajectory_parse(char *text, const char *path, trajectory *out, char *error, size_t error_bytes)
{
    size_t room = 0;
    pose_list list = {.rest = text, .exact = true};
    const char *wrong = NULL;
    *out = (trajectory){0};
    for (pose_list_item item; wrong == NULL && pose_list_next(&list, &item);) {
        wrong = append(out, &room, &(trajectory_pose){.stamp_ns = item.stamp_ns, .pose = item.pose});
    }
    int status = wrong == NULL ? pose_list_end(&list, path, error, error_bytes)
                               : t3r_reason(error, error_bytes, "%s: %s", path, wrong);
    if (status != 0) {
        trajectory_free(out);
        return -1;
    }
    out->kind = list.euroc ? "EuRoC" : "TUM";
    out->losses = list.losses;
    order(out);
    return 0;
}

/* Finds the stream on the topic, or the only one with poses. */
static int find_stream(const t3r_recording *bag, const char *path, const char *topic, uint32_t *found, char *error,
                       size_t error_bytes)
{
    uint32_t matches = 0;
    for (uint32_t i = 0; i < t3r_recording_stream_count(bag); i++) {
        bool named = topic == NULL || strcmp(t3r_recording_stream(bag, i).topic, topic) == 0;
        if (named && t3r_recording_pose_count(bag, i) > 0) {
            *found = i;
            matches++;
        }
    }
    if (matches == 1) {
        return 0;
    }
    if (topic != NULL) {
        return t3r_reason(error, error_bytes, "%s: no PoseStamped or TransformStamped on %s", path, topic);
    }
    return t3r_reason(error, error_bytes,
                      matches == 0 ? "%s: holds no PoseStamped and no TransformStamped"
                                   : "%s: several topics hold poses: name one with --pose-topic",
                      path);
}

static int take_poses(const t3r_recording *bag, const char *path, uint32_t stream, trajectory *out, char *error,
                      size_t error_bytes)
{
    size_t room = 0;
    const t3r_stream_info info = t3r_recording_stream(bag, stream);
    const char *wrong = NULL;
    pose_losses_add(&out->losses, info.left_out, "a message %s", info.fault);
    for (uint32_t i = 0; i < t3r_recording_pose_count(bag, stream) && wrong == NULL; i++) {
        t3r_recorded_pose p = t3r_recording_pose(bag, stream, i);
        trajectory_pose pose = {.stamp_ns = p.stamp_ns};
        memcpy(pose.pose.position, p.position, sizeof p.position);
        memcpy(pose.pose.rotation, p.rotation, sizeof p.rotation);
        const char *unusable = pose_check_position(p.position);
        if (unusable != NULL) {
            pose_losses_add(&out->losses, 1, "pose %u: %s", i, unusable);
            continue;
        }
        if (pose_check(&pose.pose) != NULL) {
            quaternion_normalise(pose.pose.rotation); /* it has a direction: checked when it was indexed */
        }
        wrong = append(out, &room, &pose);
    }
    if (wrong == NULL && out->count == 0) {
        wrong = out->losses.first;
    }
    order(out);
    return wrong == NULL ? 0 : t3r_reason(error, error_bytes, "%s: %s", path, wrong);
}

static int read_bag(const char *path, const char *topic, trajectory *out, char *error, size_t error_bytes)
{
    t3r_recording *bag = t3r_recording_open(path, error, error_bytes);
    if (bag == NULL) {
        return -1;
    }
    uint32_t stream = 0;
    *out = (trajectory){.kind = "bag"};
    int status = find_stream(bag, path, topic, &stream, error, error_bytes);
    if (status == 0) {
        status = take_poses(bag, path, stream, out, error, error_bytes);
    }
    t3r_recording_close(bag);
    if (status != 0) {
        trajectory_free(out);
    }
    return status;
}

/* Whether a path is a bag, also one that must be converted before it is read. */
static bool is_bag(const char *path)
{
    uint8_t first[16];
    FILE *file = t3r_file_open(path, NULL, 0);
    const size_t count = file != NULL ? fread(first, 1, sizeof first, file) : 0;
    if (file != NULL) {
        fclose(file);
    }
    return t3r_recording_is_folder(path) ||
           (count > 0 && (t3r_mcap_magic_error(first, count) == NULL || t3r_mcap_other_file(first, count) != NULL));
}

int trajectory_read(const char *path, const char *topic, trajectory *out, char *error, size_t error_bytes)
{
    *out = (trajectory){0};
    if (is_bag(path)) {
        return read_bag(path, topic, out, error, error_bytes);
    }
    if (topic != NULL) {
        return t3r_reason(error, error_bytes, "%s: --pose-topic names a topic of a bag, and this is a list", path);
    }
    size_t count;
    char *text = (char *)t3r_file_bytes(path, T3R_LIMIT_TEXT_BYTES, &count, error, error_bytes);
    const int status = text == NULL ? -1 : trajectory_parse(text, path, out, error, error_bytes);
    free(text);
    return status;
}

bool trajectory_at(const trajectory *t, int64_t stamp_ns, rigid *pose)
{
    size_t low = 0, high = t->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (t->poses[middle].stamp_ns < stamp_ns) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    if (low < t->count && t->poses[low].stamp_ns == stamp_ns) {
        *pose = t->poses[low].pose;
        return true;
    }
    if (low == 0 || low == t->count) {
        return false;
    }
    trajectory_pose a = t->poses[low - 1], b = t->poses[low];
    /* b is later; only uint64_t holds the largest gap between stamps of a bag */
    uint64_t gap = (uint64_t)b.stamp_ns - (uint64_t)a.stamp_ns;
    if (gap > TRAJECTORY_BRACKET_NS) {
        return false;
    }
    quaternion_normalise(a.pose.rotation);
    quaternion_normalise(b.pose.rotation);
    *pose = rigid_between(&a.pose, &b.pose, (double)(stamp_ns - a.stamp_ns) / (double)gap);
    return true;
}

bool trajectory_at_offset(const trajectory *t, int64_t stamp_ns, int64_t offset_ns, rigid *pose)
{
    bool holds = offset_ns >= 0 ? stamp_ns <= INT64_MAX - offset_ns : stamp_ns >= INT64_MIN - offset_ns;
    return holds && trajectory_at(t, stamp_ns + offset_ns, pose);
}
