/* SPDX-License-Identifier: Apache-2.0 */
/* A pose is camera to world, 4x4 or 3x4, x right, y down, z forward. Depth pictures have 16 bits, in millimetres unless
 * specified otherwise. Camera matrices are 4x4 or 3x3; pixel (0, 0) is the centre of the top-left pixel. */
#define _GNU_SOURCE /* versionsort() */
#include "import/folders/pose_files.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geometry/pose_matrix.h"
#include "host/file_bytes.h"
#include "host/reason.h"
#include "import/folders/pose_layout.h"
#include "import/frames/align_depth.h"
#include "import/frames/frame.h"
#include "import/frames/rejected.h"
#include "import/poses/matrix_text.h"
#include "mcap/reader_limits.h"

#define PATH_BYTES 1024
#define ERROR_BYTES 1024
#define FILE_BYTES 65536u /* most bytes of a matrix */
#define MILLIMETRE 0.001

/* A camera's place on the device: from its own frame to one that all cameras share. */
static const char *const colour_places[] = {"intrinsic/extrinsic_color.txt", "extrinsic_color.txt", NULL};
static const char *const depth_places[] = {"intrinsic/extrinsic_depth.txt", "extrinsic_depth.txt", NULL};

/* Shared by all frames of a folder. */
typedef struct cameras {
    posed_intrinsics colour, depth; /* depth.fx 0: same view as colour */
    rigid from_depth;               /* to colour's camera, in depth steps */
    bool is_moved;                  /* from_depth is not the identity */
} cameras;

bool pose_files_are_there(const char *directory)
{
    return pose_layout_of(directory) != NULL;
}

/* Reads a matrix as 4x4, completed by rows and columns of the identity. columns: 3 for a lens, 4 for a pose. */
static int read_matrix(const char *directory, const char *name, uint32_t columns, double matrix[16], char *error,
                       size_t error_bytes)
{
    double numbers[MATRIX_NUMBERS_MOST];
    uint32_t count = 0;
    size_t bytes;
    char *path = posed_path(directory, name);
    if (path == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    int status = -1;
    char *text = (char *)t3r_file_bytes(path, FILE_BYTES, &bytes, error, error_bytes);
    if (text != NULL) {
        const char *wrong = matrix_text_parse(text, numbers, &count);
        wrong = wrong == NULL && count != 16 && count != 3 * columns
                    ? columns == 3 ? "not 16 or 9 numbers" : "not 16 or 12 numbers"
                    : wrong;
        status = wrong == NULL ? 0 : t3r_reason(error, error_bytes, "%s: %s", path, wrong);
    }
    const uint32_t wide = count == 16 ? 4 : columns;
    for (uint32_t i = 0; i < 16 && status == 0; i++) {
        const uint32_t x = i % 4, y = i / 4;
        matrix[i] = x < wide && y * wide + x < count ? numbers[y * wide + x] : x == y;
    }
    free(text);
    free(path);
    return status;
}

static int read_lens(const char *directory, const char *name, posed_intrinsics *out, char *error, size_t error_bytes)
{
    double m[16];
    if (read_matrix(directory, name, 3, m, error, error_bytes) != 0) {
        return -1;
    }
    if (!(m[0] > 0 && m[5] > 0) || !isfinite(m[0] + m[5] + m[2] + m[6]) || m[1] != 0 || m[4] != 0) {
        return t3r_reason(error, error_bytes, "%s/%s: not a camera matrix: fx 0 cx, 0 fy cy", directory, name);
    }
    *out = posed_intrinsics_pinhole(m[0], m[5], m[2], m[6]);
    return 0;
}

/* Reads colour's lens, and depth's if it has its own. */
static int read_lenses(const char *directory, const pose_layout *layout, const posed_folder_options *options,
                       cameras *out, char *error, size_t error_bytes)
{
    const char *colour = pose_layout_first(directory, layout->colour_lenses);
    const char *depth = pose_layout_first(directory, layout->depth_lenses);
    if (options != NULL && options->intrinsics != NULL) {
        out->colour = posed_intrinsics_of(options->intrinsics);
    } else if (colour == NULL && options != NULL && options->without_intrinsics) {
        out->colour = posed_intrinsics_unknown();
    } else if (colour == NULL) {
        return t3r_reason(error, error_bytes, "%s: %s", directory, layout->lens_hint);
    } else if (read_lens(directory, colour, &out->colour, error, error_bytes) != 0) {
        return -1;
    }
    return depth != NULL ? read_lens(directory, depth, &out->depth, error, error_bytes) : 0;
}

/* Reads the first of the files that exists; without one the camera is at the device's own place. */
static int read_place(const char *directory, const char *const *names, rigid *out, char *error, size_t error_bytes)
{
    double matrix[16];
    const char *name = pose_layout_first(directory, names);
    *out = rigid_identity;
    if (name == NULL) {
        return 0;
    }
    if (read_matrix(directory, name, 4, matrix, error, error_bytes) != 0) {
        return -1;
    }
    const char *wrong = pose_of_matrix(matrix, T3R_AXES_OPENCV, out);
    return wrong == NULL ? 0 : t3r_reason(error, error_bytes, "%s/%s: %s", directory, name, wrong);
}

/* Computes the transform from depth's camera to colour's: to the frame that both share, then back. */
static int read_places(const char *directory, double depth_unit, cameras *out, char *error, size_t error_bytes)
{
    rigid colour, depth;
    if (read_place(directory, colour_places, &colour, error, error_bytes) != 0 ||
        read_place(directory, depth_places, &depth, error, error_bytes) != 0) {
        return -1;
    }
    colour = rigid_inverse(&colour);
    out->from_depth = rigid_compose(&colour, &depth);
    for (int i = 0; i < 3; i++) {
        out->is_moved =
            out->is_moved || fabs(out->from_depth.position[i]) > 1e-6 || fabs(out->from_depth.rotation[1 + i]) > 1e-6;
        out->from_depth.position[i] /= depth_unit;
    }
    return out->is_moved && out->depth.fx == 0
               ? t3r_reason(error, error_bytes,
                            "%s: extrinsic_*.txt part the cameras of colour and depth, but depth's has no "
                            "intrinsic_depth.txt",
                            directory)
               : 0;
}

/* Makes the frame of a pose, or rejects it. A lost pose counts as none if poses may be missing. */
static void add_frame(const char *directory, const pose_layout *layout, const char *pose_name, const char *stem,
                      bool without_poses, posed_frame *frame)
{
    double matrix[16] = {0};
    char reason[ERROR_BYTES] = "";
    frame->image = pose_layout_find(directory, layout->colours, stem, layout->colour_endings);
    frame->depth = pose_layout_find(directory, layout->depths, stem, layout->depth_endings);
    frame->no_depth = layout->no_depth;
    frame->pose = rigid_identity;
    if (frame->image == NULL) {
        rejected_mark(frame, "%s: there is no picture of that name", pose_name);
        return;
    }
    if (read_matrix(directory, pose_name, 4, matrix, reason, sizeof reason) != 0) {
        rejected_mark(frame, "%s: %s", frame->image, reason);
        return;
    }
    bool lost = false;
    for (int i = 0; i < 16; i++) {
        lost = lost || !isfinite(matrix[i]);
    }
    const char *wrong =
        lost ? "is not finite: the pose was lost" : pose_of_matrix(matrix, T3R_AXES_OPENCV, &frame->pose);
    frame->posed = wrong == NULL;
    if (wrong != NULL && !(lost && without_poses)) {
        rejected_mark(frame, lost ? "%s: %s %s" : "%s: %s: %s", frame->image, pose_name, wrong);
    }
}

/* Drops depth's lens if it sees the same as colour's from the same place. */
static int compare_lenses(const char *directory, const posed_frame *frame, cameras *shared, char *error,
                          size_t error_bytes)
{
    uint32_t width, height, depth_width, depth_height;
    if (frame->depth == NULL || shared->depth.fx == 0 || shared->is_moved) {
        return 0;
    }
    if (import_picture_size(directory, frame, &width, &height, error, error_bytes) != 0 ||
        import_depth_size(directory, frame, &depth_width, &depth_height, error, error_bytes) != 0) {
        return 1;
    }
    if (align_depth_same(&frame->intrinsics, &shared->depth, width, height, depth_width, depth_height)) {
        shared->depth = (posed_intrinsics){0};
    }
    return 0;
}

static int add_all(const char *directory, const char *folder, const pose_layout *layout, struct dirent **entries,
                   int count, const posed_folder_options *options, posed_folder *out, char *error, size_t error_bytes)
{
    cameras shared = {0};
    char reason[ERROR_BYTES] = "";
    if (read_lenses(directory, layout, options, &shared, error, error_bytes) != 0 ||
        read_places(directory, out->depth_unit, &shared, error, error_bytes) != 0) {
        return -1;
    }
    const bool without_poses = options != NULL && options->without_poses;
    bool compared = false;
    for (int i = 0; i < count; i++) {
        char pose_name[PATH_BYTES], stem[256]; /* a file name has at most 255 bytes */
        const bool here = strcmp(folder, ".") == 0;
        snprintf(pose_name, sizeof pose_name, "%s%s%s", here ? "" : folder, here ? "" : "/", entries[i]->d_name);
        snprintf(stem, sizeof stem, "%.*s", (int)(strlen(entries[i]->d_name) - strlen(layout->pose_ending)),
                 entries[i]->d_name);
        posed_frame *frame = &out->frames[out->frame_count++];
        add_frame(directory, layout, pose_name, stem, without_poses, frame);
        frame->intrinsics = shared.colour;
        /* unreadable pictures are reported later, where they are read */
        compared = compared || (frame->depth != NULL && !frame->rejected &&
                                compare_lenses(directory, frame, &shared, reason, sizeof reason) == 0);
        frame->depth_lens = shared.depth;
        frame->from_depth = shared.from_depth;
    }
    return 0;
}

/* Frees the entries that are no poses, and returns the number of the others, whose order is kept. */
static int keep_poses(const pose_layout *layout, struct dirent **entries, int count)
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        if (pose_layout_is_pose(layout, entries[i]->d_name)) {
            entries[kept++] = entries[i];
        } else {
            free(entries[i]);
        }
    }
    return kept;
}

int pose_files_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                    size_t error_bytes)
{
    struct dirent **entries;
    const pose_layout *layout = pose_layout_of(directory);
    const char *name = pose_layout_first(directory, layout->poses);
    char *folder = posed_path(directory, name);
    int count = folder == NULL ? -1 : scandir(folder, &entries, NULL, versionsort);
    free(folder);
    if (count < 0) {
        return t3r_reason(error, error_bytes, "%s/%s: %s", directory, name, strerror(errno));
    }
    count = keep_poses(layout, entries, count);
    out->depth_unit = options != NULL && options->depth_unit != 0 ? options->depth_unit : MILLIMETRE;
    out->depth_unit_given = true;
    int status = 0;
    if (count == 0 || count > T3R_LIMIT_FRAMES) {
        status = t3r_reason(error, error_bytes, "%s/%s: %s", directory, name,
                            count == 0 ? "no file whose name ends in .txt"
                                       : T3R_LIMIT_TEXT("more than ", T3R_LIMIT_FRAMES, " poses"));
    } else {
        out->frames = calloc((size_t)count, sizeof *out->frames);
        status = out->frames == NULL
                     ? t3r_reason(error, error_bytes, "out of memory")
                     : add_all(directory, name, layout, entries, count, options, out, error, error_bytes);
    }
    for (int i = 0; i < count; i++) {
        free(entries[i]);
    }
    free(entries);
    return status;
}
