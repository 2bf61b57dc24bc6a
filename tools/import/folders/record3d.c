/* SPDX-License-Identifier: Apache-2.0 */
/* An unpacked .r3d: metadata, and rgbd with N.jpg, N.depth (float32 in metres, packed with LZFSE) and N.conf. The
 * export with EXR: metadata.json, rgb and depth. Poses are camera to world as qx qy qz qw x y z, with OpenGL camera
 * axes. K is a 3x3 matrix column by column, in pixels of pictures of w x h, measured as in nerfstudio: from the corner
 * of the top-left pixel. */
#include "import/folders/record3d.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/tables/json_input.h"
#include "geometry/pose_check.h"
#include "host/file_bytes.h"
#include "host/reason.h"
#include "import/depth/exr_depth.h"
#include "import/frames/picture_folder.h"
#include "import/frames/rejected.h"
#include "mcap/reader_limits.h"

#define DEPTH_MAGIC_BYTES 4
#define MILLIMETRE 0.001 /* step that depth is rounded to */
#define NAME_BYTES 64

/* The file layout of one of its exports. */
typedef struct layout {
    const char *metadata, *pictures, *depth, *depth_ending;
} layout;

static const layout layouts[] = {
    {"metadata", "rgbd", "rgbd", ".depth"},
    {"metadata.json", "rgb", "depth", ".exr"},
};

static const layout *layout_of(const char *directory)
{
    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++) {
        if (posed_exists(directory, layouts[i].metadata) && posed_exists(directory, layouts[i].pictures)) {
            return &layouts[i];
        }
    }
    return NULL;
}

bool record3d_is(const char *directory)
{
    return layout_of(directory) != NULL;
}

/* Reads exactly `count` finite numbers. */
static bool take_numbers(const cJSON *array, int count, double *numbers)
{
    if (!cJSON_IsArray(array) || cJSON_GetArraySize(array) != count) {
        return false;
    }
    const cJSON *item;
    cJSON_ArrayForEach(item, array)
    {
        if (!cJSON_IsNumber(item) || !isfinite(item->valuedouble)) {
            return false;
        }
        *numbers++ = item->valuedouble;
    }
    return true;
}

/* Reads a side of pictures; 0 if missing. */
static bool take_side(const cJSON *root, const char *name, uint32_t *side)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(root, name);
    *side = 0;
    if (item == NULL) {
        return true;
    }
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= 1 && item->valuedouble <= T3R_MAX_SIDE) ||
        floor(item->valuedouble) != item->valuedouble) {
        return false;
    }
    *side = (uint32_t)item->valuedouble;
    return true;
}

/* Returns NULL, or what is wrong. */
static const char *take_pose(const cJSON *array, posed_frame *out)
{
    static const rigid half_about_x = {{0, 0, 0}, {0, 1, 0, 0}}; /* from y up, z backward to y down, z forward */
    double n[7];
    if (!take_numbers(array, 7, n)) {
        return "not 7 finite numbers: qx qy qz qw x y z";
    }
    rigid pose = {{n[4], n[5], n[6]}, {n[3], n[0], n[1], n[2]}};
    const char *wrong = pose_check(&pose);
    if (wrong != NULL) {
        return wrong;
    }
    out->pose = rigid_compose(&pose, &half_about_x);
    out->posed = true;
    return NULL;
}

static posed_intrinsics lens_of(const double fx_fy_cx_cy[4], const uint32_t sides[2])
{
    return (posed_intrinsics){.width = NAN,
                              .height = NAN,
                              .grid_width = sides[0],
                              .grid_height = sides[1],
                              .fx = fx_fy_cx_cy[0],
                              .fy = fx_fy_cx_cy[1],
                              .cx = fx_fy_cx_cy[2],
                              .cy = fx_fy_cx_cy[3],
                              .angle_x = NAN,
                              .angle_y = NAN};
}

static int parse_frames(const cJSON *root, const uint32_t sides[2], posed_folder *out, char *error, size_t error_bytes)
{
    const cJSON *poses = cJSON_GetObjectItemCaseSensitive(root, "poses");
    const cJSON *lenses = cJSON_GetObjectItemCaseSensitive(root, "perFrameIntrinsicCoeffs");
    const int count = cJSON_IsArray(poses) ? cJSON_GetArraySize(poses) : 0;
    double k[9], lens[4];
    if (count == 0 || count > T3R_LIMIT_FRAMES) {
        return t3r_reason(error, error_bytes, "poses: %s",
                          count == 0 ? "not an array of poses" : T3R_LIMIT_TEXT("more than ", T3R_LIMIT_FRAMES, ""));
    }
    if (!take_numbers(cJSON_GetObjectItemCaseSensitive(root, "K"), 9, k)) {
        return t3r_reason(error, error_bytes, "K: not 9 finite numbers");
    }
    const bool own_lenses = cJSON_IsArray(lenses) && cJSON_GetArraySize(lenses) == count;
    out->frames = calloc((size_t)count, sizeof *out->frames);
    if (out->frames == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    const cJSON *own = own_lenses ? lenses->child : NULL, *pose;
    cJSON_ArrayForEach(pose, poses)
    {
        posed_frame *frame = &out->frames[out->frame_count++];
        const char *wrong = take_pose(pose, frame);
        if (wrong != NULL) {
            rejected_mark(frame, "poses[%u]: %s", out->frame_count - 1, wrong);
        }
        memcpy(lens, (const double[4]){k[0], k[4], k[6], k[7]}, sizeof lens);
        if (own != NULL && !take_numbers(own, 4, lens)) {
            rejected_mark(frame, "perFrameIntrinsicCoeffs[%u]: not 4 finite numbers: fx fy cx cy",
                          out->frame_count - 1);
        }
        frame->intrinsics = lens_of(lens, sides);
        own = own != NULL ? own->next : NULL;
    }
    return 0;
}

int record3d_parse(const char *text, size_t bytes, posed_folder *out, uint32_t depth_sides[2], char *error,
                   size_t error_bytes)
{
    uint32_t sides[2];
    memset(out, 0, sizeof *out);
    cJSON *root = json_parse(text, bytes, error, error_bytes);
    if (root == NULL) {
        return -1;
    }
    int status;
    if (!take_side(root, "w", &sides[0]) || !take_side(root, "h", &sides[1]) || sides[0] == 0 || sides[1] == 0) {
        status = t3r_reason(error, error_bytes, "w, h: not whole numbers of pixels from 1 to 4096");
    } else if (!take_side(root, "dw", &depth_sides[0]) || !take_side(root, "dh", &depth_sides[1])) {
        status = t3r_reason(error, error_bytes, "dw, dh: not whole numbers of pixels from 1 to 4096");
    } else {
        status = parse_frames(root, sides, out, error, error_bytes);
    }
    out->depth_unit = MILLIMETRE;
    out->depth_unit_given = true;
    cJSON_Delete(root);
    return status;
}

/* Whether depth of that file is packed with LZFSE, whose blocks begin with "bvx", and cannot be read. */
static int is_packed(const char *directory, const char *name, bool *packed, char *error, size_t error_bytes)
{
    char first[DEPTH_MAGIC_BYTES] = {0};
    char *path = posed_path(directory, name);
    FILE *file = path != NULL ? t3r_file_open(path, error, error_bytes) : NULL;
    if (path == NULL) {
        (void)t3r_reason(error, error_bytes, "out of memory");
    }
    free(path);
    if (file == NULL) {
        return -1;
    }
    *packed = fread(first, 1, sizeof first, file) == sizeof first && memcmp(first, "bvx", 3) == 0;
    fclose(file);
    return 0;
}

static int add_depth(const char *directory, const layout *l, uint32_t index, const uint32_t sides[2], double unit,
                     posed_frame *frame, uint32_t *packed_count, char *error, size_t error_bytes)
{
    char name[NAME_BYTES];
    const bool exr = exr_depth_is(l->depth_ending);
    bool packed = exr && exr_depth_missing() != NULL;
    snprintf(name, sizeof name, "%s/%u%s", l->depth, index, l->depth_ending);
    if (!posed_exists(directory, name)) {
        return 0;
    }
    if (!exr && is_packed(directory, name, &packed, error, error_bytes) != 0) {
        return -1;
    }
    *packed_count += packed;
    if (packed) {
        return 0;
    }
    if (!exr && (sides[0] == 0 || sides[1] == 0)) {
        return t3r_reason(error, error_bytes, "%s/%s: dw, dh: missing, but there is depth in %s", directory,
                          l->metadata, name);
    }
    frame->depth = strdup(name);
    frame->depth_raw = (raw_depth){RAW_DEPTH_PLAIN, sides[0], sides[1], unit};
    return frame->depth != NULL ? 0 : t3r_reason(error, error_bytes, "out of memory");
}

static int add_names(const char *directory, const layout *l, const uint32_t depth_sides[2], posed_folder *out,
                     char *error, size_t error_bytes)
{
    uint32_t packed = 0;
    for (uint32_t i = 0; i < out->frame_count; i++) {
        posed_frame *frame = &out->frames[i];
        char name[NAME_BYTES];
        snprintf(name, sizeof name, "%s/%u.png", l->pictures, i);
        if (!posed_exists(directory, name)) {
            snprintf(name, sizeof name, "%s/%u.jpg", l->pictures, i);
        }
        frame->image = strdup(name);
        if (frame->image == NULL) {
            return t3r_reason(error, error_bytes, "out of memory");
        }
        if (add_depth(directory, l, i, depth_sides, out->depth_unit, frame, &packed, error, error_bytes) != 0) {
            return -1;
        }
    }
    if (packed > 0) {
        (void)text_list_add(&out->remarks, "depth of %u frames is left out: %s", packed,
                            exr_depth_is(l->depth_ending)
                                ? exr_depth_missing()
                                : "rgbd/N.depth is packed with LZFSE, which is not read; lzfse -decode unpacks it");
    }
    if (posed_exists(directory, "rgbd/0.conf") || posed_exists(directory, "conf")) {
        (void)text_list_add(&out->remarks,
                            "the confidence of depth (.conf) is not read: depth of all confidences counts");
    }
    return picture_folder_rest(directory, l->pictures, "there is no pose of it", out, error, error_bytes);
}

int record3d_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                  size_t error_bytes)
{
    const layout *l = layout_of(directory);
    if (options != NULL && options->intrinsics != NULL) {
        return t3r_reason(error, error_bytes, "%s/%s: has its own intrinsics; --intrinsics is for folders without",
                          directory, l->metadata);
    }
    char *path = posed_path(directory, l->metadata);
    if (path == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    size_t bytes;
    uint32_t depth_sides[2];
    char reason[512];
    char *text = (char *)t3r_file_bytes(path, T3R_LIMIT_TEXT_BYTES, &bytes, error, error_bytes);
    int status = -1;
    if (text != NULL) {
        status = record3d_parse(text, bytes, out, depth_sides, reason, sizeof reason);
        if (status != 0) {
            t3r_reason(error, error_bytes, "%s: %s", path, reason);
        }
    }
    free(text);
    free(path);
    if (options != NULL && options->depth_unit != 0) {
        out->depth_unit = options->depth_unit;
    }
    return status == 0 ? add_names(directory, l, depth_sides, out, error, error_bytes) : -1;
}
