/* SPDX-License-Identifier: Apache-2.0 */
/* TUM RGB-D folders: rgb.txt, depth.txt (optional) and groundtruth.txt, whose lines begin with a time in seconds. Depth
 * is the nearest in time within 20 ms; poses are interpolated between neighbours at most 100 ms apart, else the nearest
 * within 20 ms is used, else the picture is left out. */
#include "import/folders/tum_rgbd.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry/quaternion.h"
#include "host/file_bytes.h"
#include "host/grow.h"
#include "host/reason.h"
#include "import/poses/pose_lines.h"
#include "import/poses/pose_list.h"
#include "mcap/reader_limits.h"
#include "trim3r.h"

#define NEAR_SECONDS 0.020
#define BRACKET_SECONDS 0.100
#define DEPTH_STEPS_PER_METRE 5000.0

typedef struct stamped {
    double stamp;
    size_t order; /* in the list */
    char *name;   /* for picture lists */
    rigid pose;   /* the trajectory */
} stamped;

typedef struct stamped_list {
    stamped *items;
    size_t count, room;
    pose_losses bad; /* lines that are left out */
} stamped_list;

typedef struct intrinsics_row {
    const char *set;
    double numbers[INTRINSICS_NUMBERS];
} intrinsics_row;

/* Colour camera calibrations as published with the data set,
 * https://cvg.cit.tum.de/data/datasets/rgbd-dataset/file_formats (formerly vision.in.tum.de), "Intrinsic Camera
 * Calibration of the Kinect". Pixel (0, 0) is the centre of the top-left pixel. freiburg3 is rectified. */
static const intrinsics_row published[] = {
    {"freiburg1", {517.3, 516.5, 318.6, 255.3, 0.2624, -0.9531, -0.0054, 0.0026, 1.1633}},
    {"freiburg2", {520.9, 521.0, 325.1, 249.7, 0.2312, -0.7849, -0.0033, -0.0001, 0.9172}},
    {"freiburg3", {535.4, 539.2, 320.1, 247.6, 0, 0, 0, 0, 0}},
};

static void list_free(stamped_list *list)
{
    for (size_t i = 0; i < list->count; i++) {
        free(list->items[i].name);
    }
    free(list->items);
    *list = (stamped_list){0};
}

static int by_stamp(const void *a, const void *b)
{
    const stamped *x = a, *y = b;
    return x->stamp > y->stamp ? 1 : x->stamp < y->stamp ? -1 : (x->order > y->order) - (x->order < y->order);
}

static bool append(stamped_list *list, const stamped *item)
{
    stamped *grown = t3r_grow(list->items, list->count, &list->room, sizeof *grown);
    if (grown != NULL) {
        list->items = grown;
        list->items[list->count] = *item;
        list->items[list->count].order = list->count;
        list->count++;
    }
    return grown != NULL;
}

/* Parses a line of a list of pictures. Returns NULL, or what is wrong with it. */
static const char *parse_picture(char *line, stamped *item)
{
    char *at = line;
    *item = (stamped){0};
    if (!pose_lines_number(&at, &item->stamp) || !isfinite(item->stamp)) {
        return "no time stamp";
    }
    const char *name = strtok_r(at, " \t\r", &at);
    item->name = name != NULL ? strdup(name) : NULL;
    return name == NULL ? "no file name" : NULL;
}

static int parse_pictures(const char *path, char *text, stamped_list *list, char *error, size_t error_bytes)
{
    pose_lines lines = {.rest = text};
    for (char *line; (line = pose_lines_next(&lines)) != NULL;) {
        if (list->count == T3R_LIMIT_PICTURES) {
            return t3r_reason(error, error_bytes, "%s: line %zu: more than %d entries", path, lines.number,
                              T3R_LIMIT_PICTURES);
        }
        stamped item;
        const char *wrong = parse_picture(line, &item);
        if (wrong != NULL) {
            pose_losses_add(&list->bad, 1, "line %zu: %s", lines.number, wrong);
        } else if (item.name == NULL || !append(list, &item)) {
            free(item.name);
            return t3r_reason(error, error_bytes, "%s: out of memory", path);
        }
    }
    return list->count > 0
               ? 0
               : t3r_reason(error, error_bytes, "%s: %s", path, list->bad.count > 0 ? list->bad.first : "no entry");
}

static int parse_poses(const char *path, char *text, stamped_list *list, char *error, size_t error_bytes)
{
    pose_list poses = {.rest = text};
    for (pose_list_item item; pose_list_next(&poses, &item);) {
        stamped pose = {.stamp = item.seconds, .pose = item.pose};
        quaternion_normalise(pose.pose.rotation);
        if (!append(list, &pose)) {
            return t3r_reason(error, error_bytes, "%s: out of memory", path);
        }
    }
    list->bad = poses.losses;
    return pose_list_end(&poses, path, error, error_bytes);
}

/* Leaves out lines with the time stamp of an earlier one. Repeated poses that are equal are no loss. */
static void drop_repeated(stamped_list *list, bool poses)
{
    size_t kept = 0;
    for (size_t i = 0; i < list->count; i++) {
        stamped *item = &list->items[i];
        if (kept == 0 || list->items[kept - 1].stamp < item->stamp) {
            list->items[kept++] = *item;
            continue;
        }
        if (!poses || memcmp(&list->items[kept - 1].pose, &item->pose, sizeof item->pose) != 0) {
            pose_losses_add_repeated(&list->bad, item->stamp);
        }
        free(item->name);
    }
    list->count = kept;
}

static int read_list(const char *directory, const char *name, bool poses, stamped_list *list, char *error,
                     size_t error_bytes)
{
    char *path = posed_path(directory, name);
    if (path == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    size_t bytes = 0;
    char *text = (char *)t3r_file_bytes(path, T3R_LIMIT_TEXT_BYTES, &bytes, error, error_bytes);
    int status = text == NULL ? -1
                 : poses      ? parse_poses(path, text, list, error, error_bytes)
                              : parse_pictures(path, text, list, error, error_bytes);
    if (status == 0) {
        qsort(list->items, list->count, sizeof *list->items, by_stamp);
        drop_repeated(list, poses);
    }
    free(text);
    free(path);
    return status;
}

/* Returns the index of the first item not before `stamp`; count when there is none. */
static size_t lower_bound(const stamped_list *list, double stamp)
{
    size_t low = 0, high = list->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (list->items[middle].stamp < stamp) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Returns the nearest item within NEAR_SECONDS; the earlier of two equally near. */
static const stamped *nearest(const stamped_list *list, double stamp)
{
    size_t after = lower_bound(list, stamp);
    const stamped *best = NULL;
    double gap = NEAR_SECONDS;
    for (size_t i = after > 0 ? after - 1 : 0; i <= after && i < list->count; i++) {
        double here = fabs(list->items[i].stamp - stamp);
        if (here <= gap && (best == NULL || here < gap)) {
            best = &list->items[i];
            gap = here;
        }
    }
    return best;
}

static bool find_pose(const stamped_list *trajectory, double stamp, rigid *pose)
{
    size_t after = lower_bound(trajectory, stamp);
    if (after > 0 && after < trajectory->count) {
        const stamped *a = &trajectory->items[after - 1], *b = &trajectory->items[after];
        double gap = b->stamp - a->stamp;
        if (gap <= BRACKET_SECONDS) {
            *pose = rigid_between(&a->pose, &b->pose, (stamp - a->stamp) / gap);
            return true;
        }
    }
    const stamped *only = nearest(trajectory, stamp);
    if (only != NULL) {
        *pose = only->pose;
    }
    return only != NULL;
}

static int find_intrinsics(const char *directory, const posed_folder_options *options, posed_intrinsics *out,
                           char *error, size_t error_bytes)
{
    const double *numbers = options != NULL ? options->intrinsics : NULL;
    if (numbers == NULL) {
        char *full = realpath(directory, NULL);
        const intrinsics_row *row = NULL;
        for (size_t i = 0; full != NULL && i < sizeof published / sizeof *published; i++) {
            const char *base = strrchr(full, '/');
            if (strstr(base != NULL ? base : full, published[i].set) != NULL) {
                row = &published[i];
            }
        }
        free(full);
        if (row == NULL && options != NULL && options->without_intrinsics) {
            *out = posed_intrinsics_unknown();
            return 0;
        }
        if (row == NULL) {
            return t3r_reason(error, error_bytes,
                              "%s: intrinsics unknown: a TUM RGB-D folder does not hold them, and its name has none of "
                              "freiburg1, freiburg2, freiburg3; give --intrinsics " INTRINSICS_FORM " "
                              "(525,525,319.5,239.5 is the data set's own default)",
                              directory);
        }
        numbers = row->numbers;
    }
    *out = posed_intrinsics_of(numbers);
    return 0;
}

/* Notes the lines of a list that are left out. */
static int note_list(const char *name, const stamped_list *list, posed_folder *out)
{
    return list->bad.count == 0 ? 0
                                : text_list_add(&out->left_out.frames, "%s: lines left out: %" PRIu64 "; the first: %s",
                                                name, list->bad.count, list->bad.first);
}

static int join(const stamped_list *colour, const stamped_list *depth, const stamped_list *trajectory,
                const posed_intrinsics *intrinsics, bool without_poses, posed_folder *out, char *error,
                size_t error_bytes)
{
    if (colour->count > T3R_LIMIT_FRAMES) {
        return t3r_reason(error, error_bytes, "rgb.txt: more than %d pictures", T3R_LIMIT_FRAMES);
    }
    out->frames = calloc(colour->count, sizeof *out->frames);
    if (out->frames == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    for (size_t i = 0; i < colour->count; i++) {
        posed_frame *frame = &out->frames[out->frame_count];
        frame->posed = find_pose(trajectory, colour->items[i].stamp, &frame->pose);
        if (!frame->posed && !without_poses) {
            if (text_list_add(&out->left_out.frames, "%s: no pose near it in time", colour->items[i].name) != 0) {
                return t3r_reason(error, error_bytes, "out of memory");
            }
            continue;
        }
        out->frame_count++;
        if (!frame->posed) {
            frame->pose = rigid_identity;
        }
        const stamped *measured = nearest(depth, colour->items[i].stamp);
        frame->intrinsics = *intrinsics;
        frame->image = strdup(colour->items[i].name);
        frame->depth = measured != NULL ? strdup(measured->name) : NULL;
        if (frame->image == NULL || (measured != NULL && frame->depth == NULL)) {
            return t3r_reason(error, error_bytes, "out of memory");
        }
    }
    if (out->frame_count == 0) {
        return t3r_reason(error, error_bytes, "groundtruth.txt: no pose within 20 ms of any picture of rgb.txt");
    }
    return 0;
}

int tum_rgbd_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                  size_t error_bytes)
{
    memset(out, 0, sizeof *out);
    out->depth_unit = options != NULL && options->depth_unit != 0 ? options->depth_unit : 1 / DEPTH_STEPS_PER_METRE;
    out->depth_unit_given = true;
    posed_intrinsics intrinsics;
    stamped_list colour = {0}, depth = {0}, trajectory = {0};
    int status = find_intrinsics(directory, options, &intrinsics, error, error_bytes);
    if (status == 0) {
        status = read_list(directory, "rgb.txt", false, &colour, error, error_bytes);
    }
    bool without_poses = options != NULL && options->without_poses;
    if (status == 0 && (!without_poses || posed_exists(directory, "groundtruth.txt"))) {
        status = read_list(directory, "groundtruth.txt", true, &trajectory, error, error_bytes);
    }
    if (status == 0 && posed_exists(directory, "depth.txt")) {
        status = read_list(directory, "depth.txt", false, &depth, error, error_bytes);
    }
    if (status == 0 &&
        (note_list("rgb.txt", &colour, out) != 0 || note_list("groundtruth.txt", &trajectory, out) != 0 ||
         note_list("depth.txt", &depth, out) != 0)) {
        status = t3r_reason(error, error_bytes, "out of memory");
    }
    if (status == 0) {
        status = join(&colour, &depth, &trajectory, &intrinsics, without_poses, out, error, error_bytes);
    }
    list_free(&colour);
    list_free(&depth);
    list_free(&trajectory);
    return status;
}
