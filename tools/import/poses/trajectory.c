/* SPDX-License-Identifier: Apache-2.0 */
#include "import/poses/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry/quaternion.h"
#include "host/file_bytes.h"
#include "host/grow.h"
#include "host/reason.h"
#include "import/poses/pose_check.h"
#include "import/poses/pose_lines.h"
#include "mcap/mcap.h"
#include "mcap/reader_limits.h"
#include "recording/recording.h"

#define MAX_BYTES ((size_t)1 << 30) /* largest bag */
#define MAX_STAMP_S INT64_C(4000000000)
#define MAX_STAMP_NS (MAX_STAMP_S * 1000000000)

void trajectory_free(trajectory *t)
{
    free(t->poses);
    *t = (trajectory){0};
}

static int by_stamp(const void *a, const void *b)
{
    int64_t x = ((const trajectory_pose *)a)->stamp_ns, y = ((const trajectory_pose *)b)->stamp_ns;
    return (x > y) - (x < y);
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
    t->poses[t->count++] = *pose;
    return NULL;
}

/* Sorts by stamp; of equal stamps the first stays. */
static void order(trajectory *t)
{
    size_t kept = 0;
    qsort(t->poses, t->count, sizeof *t->poses, by_stamp);
    for (size_t i = 0; i < t->count; i++) {
        if (kept == 0 || t->poses[i].stamp_ns != t->poses[kept - 1].stamp_ns) {
            t->poses[kept++] = t->poses[i];
        }
    }
    t->count = kept;
}

/* Takes seconds with up to nine decimal places as whole nanoseconds, without binary fractions in between; *text moves
 * past them. */
static bool take_seconds(char **text, int64_t *stamp_ns)
{
    char *p = *text;
    int64_t seconds = 0, fraction = 0, unit = 100000000;
    size_t digits = 0;
    for (; *p >= '0' && *p <= '9'; p++, digits++) {
        seconds = seconds * 10 + (*p - '0');
        if (seconds > MAX_STAMP_S) {
            return false;
        }
    }
    if (*p == '.') {
        for (p++; *p >= '0' && *p <= '9'; p++, digits++) {
            fraction += (*p - '0') * unit;
            unit /= 10;
        }
    }
    *stamp_ns = seconds * 1000000000 + fraction;
    *text = p;
    return digits > 0;
}

static bool take_nanoseconds(char **text, int64_t *stamp_ns)
{
    char *p = *text;
    int64_t value = 0;
    for (; *p >= '0' && *p <= '9'; p++) {
        int64_t digit = *p - '0';
        if (value > (MAX_STAMP_NS - digit) / 10) {
            return false;
        }
        value = value * 10 + digit;
    }
    bool any = p > *text;
    *stamp_ns = value;
    *text = p;
    return any;
}

/* Returns NULL, or what is wrong with the line. */
static const char *parse_line(char *line, bool commas, trajectory_pose *out)
{
    if (commas ? !take_nanoseconds(&line, &out->stamp_ns) : !take_seconds(&line, &out->stamp_ns)) {
        return commas ? "no time in nanoseconds" : "no time in seconds";
    }
    if (*line != ' ' && *line != '\t' && *line != ',') {
        return commas ? "no whole number of nanoseconds" : "no time in seconds";
    }
    if (!pose_lines_pose(&line, commas, &out->pose)) {
        return commas ? "not 'nanoseconds,px,py,pz,qw,qx,qy,qz'" : "not 'seconds tx ty tz qx qy qz qw'";
    }
    return pose_check(&out->pose);
}

int trajectory_parse(char *text, const char *path, trajectory *out, char *error, size_t error_bytes)
{
    size_t room = 0;
    pose_lines lines = {.rest = text};
    *out = (trajectory){.kind = "TUM"};
    for (char *line; (line = pose_lines_next(&lines)) != NULL;) {
        bool commas = strchr(line, ',') != NULL;
        out->kind = commas ? "EuRoC" : out->kind;
        trajectory_pose pose;
        const char *wrong = parse_line(line, commas, &pose);
        if (wrong == NULL) {
            wrong = append(out, &room, &pose);
        }
        if (wrong != NULL) {
            trajectory_free(out);
            return t3r_reason(error, error_bytes, "%s: line %zu: %s", path, lines.number, wrong);
        }
    }
    if (out->count == 0) {
        return t3r_reason(error, error_bytes, "%s: holds no pose", path);
    }
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
    for (uint32_t i = 0; i < t3r_recording_pose_count(bag, stream); i++) {
        t3r_recorded_pose p = t3r_recording_pose(bag, stream, i);
        trajectory_pose pose = {.stamp_ns = p.stamp_ns};
        memcpy(pose.pose.position, p.position, sizeof p.position);
        memcpy(pose.pose.rotation, p.rotation, sizeof p.rotation);
        const char *wrong = pose_check(&pose.pose);
        if (wrong == NULL) {
            wrong = append(out, &room, &pose);
        }
        if (wrong != NULL) {
            return t3r_reason(error, error_bytes, "%s: pose %u: %s", path, i, wrong);
        }
    }
    order(out);
    return 0;
}

static int read_bag(const uint8_t *bytes, size_t count, const char *path, const char *topic, trajectory *out,
                    char *error, size_t error_bytes)
{
    char what[256];
    t3r_recording *bag = t3r_recording_parse(bytes, count, what, sizeof what);
    if (bag == NULL) {
        return t3r_reason(error, error_bytes, "%s: %s", path, what);
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

int trajectory_read(const char *path, const char *topic, trajectory *out, char *error, size_t error_bytes)
{
    size_t count = 0;
    *out = (trajectory){0};
    uint8_t *bytes = t3r_file_bytes(path, MAX_BYTES, &count, error, error_bytes);
    if (bytes == NULL) {
        return -1;
    }
    bool is_bag = count >= T3R_MCAP_MAGIC_BYTES && memcmp(bytes, T3R_MCAP_MAGIC, T3R_MCAP_MAGIC_BYTES) == 0;
    int status;
    if (is_bag) {
        status = read_bag(bytes, count, path, topic, out, error, error_bytes);
    } else if (count >= 15 && memcmp(bytes, "SQLite format 3", 15) == 0) {
        status = t3r_reason(error, error_bytes, "%s: is a bag in SQLite: ros2 bag convert makes MCAP of it", path);
    } else if (count > T3R_LIMIT_TEXT_BYTES) {
        status = t3r_reason(error, error_bytes, "%s: a text of more than %u bytes", path, T3R_LIMIT_TEXT_BYTES);
    } else {
        status = trajectory_parse((char *)bytes, path, out, error, error_bytes);
    }
    free(bytes);
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
