/* pose/N.txt: camera to world, 4x4 or 3x4, x right, y down, z forward. color/N.jpg: the picture. depth/N.png: 16-bit,
 * in millimetres if nothing else is said. intrinsic/intrinsic_color.txt and intrinsic_depth.txt: 4x4 or 3x3, pixel (0,
 * 0) being the centre of the top-left pixel. */
#define _GNU_SOURCE /* versionsort() */
#include "import/pose_files.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file_bytes.h"
#include "import/align_depth.h"
#include "import/frame.h"
#include "import/matrix_text.h"
#include "import/pose_matrix.h"
#include "reader_limits.h"
#include "reason.h"

#define PATH_BYTES 1024
#define FILE_BYTES 65536u /* of a matrix */
#define MILLIMETRE 0.001

static const char *const pose_folders[] = {"pose", "poses", NULL};
static const char *const colour_folders[] = {"color", "colour", "rgb", "image", "images", NULL};
static const char *const depth_folders[] = {"depth", "depths", NULL};
static const char *const colour_endings[] = {".jpg", ".png", ".jpeg", NULL};
static const char *const depth_endings[] = {".png", NULL};
static const char *const colour_lenses[] = {"intrinsic/intrinsic_color.txt",
                                            "intrinsic/intrinsic.txt",
                                            "intrinsic_color.txt",
                                            "intrinsics.txt",
                                            "intrinsic.txt",
                                            "camera-intrinsics.txt",
                                            NULL};
static const char *const depth_lenses[] = {"intrinsic/intrinsic_depth.txt", "intrinsic_depth.txt", NULL};

static int is_text(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');
    return entry->d_name[0] != '.' && dot != NULL && strcmp(dot, ".txt") == 0;
}

/* The first of the names that is there; NULL: none. */
static const char *first_of(const char *directory, const char *const *names)
{
    while (*names != NULL && !posed_exists(directory, *names)) {
        names++;
    }
    return *names;
}

/* The file of that name in one of the folders, on the heap; NULL: there is none. */
static char *find(const char *directory, const char *const *folders, const char *stem, const char *const *endings)
{
    for (; *folders != NULL; folders++) {
        for (const char *const *ending = endings; *ending != NULL; ending++) {
            char path[PATH_BYTES];
            snprintf(path, sizeof path, "%s/%s%s", *folders, stem, *ending);
            if (posed_exists(directory, path)) {
                return strdup(path);
            }
        }
    }
    return NULL;
}

bool pose_files_are_there(const char *directory)
{
    return first_of(directory, pose_folders) != NULL && first_of(directory, colour_folders) != NULL;
}

/* A matrix as 4x4; rows and columns that the file lacks are those of the unit matrix. columns: 3 of a lens, 4 of a
 * pose. */
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
    *out = posed_intrinsics_of((const double[9]){m[0], m[5], m[2], m[6]});
    return 0;
}

/* Colour's lens, and depth's where it has one of its own. */
static int read_lenses(const char *directory, const posed_folder_options *options, posed_intrinsics *colour,
                       posed_intrinsics *depth, char *error, size_t error_bytes)
{
    const char *colour_name = first_of(directory, colour_lenses), *depth_name = first_of(directory, depth_lenses);
    *depth = (posed_intrinsics){0};
    if (options != NULL && options->intrinsics_count != 0) {
        double numbers[9] = {0};
        memcpy(numbers, options->intrinsics, options->intrinsics_count * sizeof *numbers);
        *colour = posed_intrinsics_of(numbers);
    } else if (colour_name == NULL) {
        return t3r_reason(error, error_bytes,
                          "%s: no intrinsic/intrinsic_color.txt; give --intrinsics fx,fy,cx,cy[,k1,k2,p1,p2,k3]",
                          directory);
    } else if (read_lens(directory, colour_name, colour, error, error_bytes) != 0) {
        return -1;
    }
    return depth_name != NULL ? read_lens(directory, depth_name, depth, error, error_bytes) : 0;
}

/* 1: its pose was lost. */
static int add_frame(const char *directory, const char *pose_name, const char *stem, posed_frame *frame, char *error,
                     size_t error_bytes)
{
    double matrix[16];
    if (read_matrix(directory, pose_name, 4, matrix, error, error_bytes) != 0) {
        return -1;
    }
    frame->image = find(directory, colour_folders, stem, colour_endings);
    frame->depth = find(directory, depth_folders, stem, depth_endings);
    if (frame->image == NULL) {
        return t3r_reason(error, error_bytes, "%s/%s: there is no picture of that name in %s", directory, pose_name,
                          first_of(directory, colour_folders));
    }
    frame->rotation[0] = 1;
    for (int i = 0; i < 16; i++) {
        if (!isfinite(matrix[i])) {
            return 1;
        }
    }
    const char *wrong = pose_of_matrix(matrix, AXES_OPENCV, frame->position, frame->rotation);
    frame->posed = wrong == NULL;
    return wrong == NULL ? 0 : t3r_reason(error, error_bytes, "%s/%s: %s", directory, pose_name, wrong);
}

/* Where depth's lens sees what colour's does, it is forgotten. */
static int compare_lenses(const char *directory, const posed_frame *frame, posed_intrinsics *depth, char *error,
                          size_t error_bytes)
{
    uint32_t width, height, depth_width, depth_height;
    const posed_frame measured = {.image = frame->depth};
    if (frame->depth == NULL || depth->fx == 0) {
        return 0;
    }
    if (import_picture_size(directory, frame, &width, &height, error, error_bytes) != 0 ||
        import_picture_size(directory, &measured, &depth_width, &depth_height, error, error_bytes) != 0) {
        return -1;
    }
    if (align_depth_same(&frame->intrinsics, depth, width, height, depth_width, depth_height)) {
        *depth = (posed_intrinsics){0};
    }
    return 0;
}

static int add_all(const char *directory, const char *folder, struct dirent **entries, int count,
                   const posed_folder_options *options, posed_folder *out, char *error, size_t error_bytes)
{
    posed_intrinsics colour, depth;
    if (read_lenses(directory, options, &colour, &depth, error, error_bytes) != 0) {
        return -1;
    }
    const bool without_poses = options != NULL && options->without_poses;
    bool compared = false;
    for (int i = 0; i < count; i++) {
        char pose_name[PATH_BYTES], stem[256]; /* of a file name, which has 255 bytes at most */
        snprintf(pose_name, sizeof pose_name, "%s/%s", folder, entries[i]->d_name);
        snprintf(stem, sizeof stem, "%.*s", (int)(strlen(entries[i]->d_name) - strlen(".txt")), entries[i]->d_name);
        posed_frame *frame = &out->frames[out->frame_count++];
        int status = add_frame(directory, pose_name, stem, frame, error, error_bytes);
        if (status < 0) {
            return -1;
        }
        if (status > 0 && !without_poses) {
            (void)text_list_add(&out->left_out, "%s: %s is not finite: the pose was lost", frame->image, pose_name);
            free(frame->image);
            free(frame->depth);
            *frame = (posed_frame){0};
            out->frame_count--;
            continue;
        }
        frame->intrinsics = colour;
        if (!compared && compare_lenses(directory, frame, &depth, error, error_bytes) != 0) {
            return -1;
        }
        compared = compared || frame->depth != NULL;
        frame->depth_lens = depth;
    }
    return out->frame_count > 0 ? 0 : t3r_reason(error, error_bytes, "%s/%s: no pose is finite", directory, folder);
}

int pose_files_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                    size_t error_bytes)
{
    struct dirent **entries;
    const char *name = first_of(directory, pose_folders);
    char *folder = posed_path(directory, name);
    int count = folder == NULL ? -1 : scandir(folder, &entries, is_text, versionsort);
    free(folder);
    if (count < 0) {
        return t3r_reason(error, error_bytes, "%s/%s: %s", directory, name, strerror(errno));
    }
    out->depth_unit = options != NULL && options->depth_unit != 0 ? options->depth_unit : MILLIMETRE;
    out->depth_unit_given = true;
    int status = 0;
    if (count == 0 || count > T3R_LIMIT_FRAMES) {
        status = t3r_reason(error, error_bytes, "%s/%s: %s", directory, name,
                            count == 0 ? "no file whose name ends in .txt"
                                       : T3R_LIMIT_TEXT("more than ", T3R_LIMIT_FRAMES, " poses"));
    } else {
        out->frames = calloc((size_t)count, sizeof *out->frames);
        status = out->frames == NULL ? t3r_reason(error, error_bytes, "out of memory")
                                     : add_all(directory, name, entries, count, options, out, error, error_bytes);
    }
    for (int i = 0; i < count; i++) {
        free(entries[i]);
    }
    free(entries);
    return status;
}
