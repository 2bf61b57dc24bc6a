/* SPDX-License-Identifier: Apache-2.0 */
/* transforms.json: camera-to-world matrices with OpenGL axes (x right, y up, z backward). Intrinsics are in a frame or,
 * for all frames, at the top; a frame's own win. */
#define _GNU_SOURCE /* strcasestr() */
#include "import/folders/transforms_json.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/tables/json_input.h"
#include "geometry/pose_matrix.h"
#include "host/reason.h"
#include "import/depth/exr_depth.h"
#include "import/frames/rejected.h"
#include "mcap/reader_limits.h"
#include "messages/fixed_camera.h"
#include "trim3r.h"

#define MAX_PATH_BYTES 4096u
#define REMARKED_MOST 16u     /* most remarks on unread fields */
#define NERFSTUDIO_UNIT 0.001 /* default of a depth_file_path, as in nerfstudio */

/* Every field that is read at the top or in a frame, in the order of strcmp(). */
static const char *const known[] = {"applied_scale",
                                    "camera_angle_x",
                                    "camera_angle_y",
                                    "camera_model",
                                    "confidence_path",
                                    "cx",
                                    "cy",
                                    "depth_file_path",
                                    "depth_path",
                                    "depth_unit_scale_factor",
                                    "equirectangular",
                                    "file_path",
                                    "fl_x",
                                    "fl_y",
                                    "frames",
                                    "ftheta_p0",
                                    "h",
                                    "integer_depth_scale",
                                    "is_fisheye",
                                    "k1",
                                    "k2",
                                    "k3",
                                    "k4",
                                    "k5",
                                    "k6",
                                    "latlong",
                                    "mask_path",
                                    "orthographic",
                                    "p1",
                                    "p2",
                                    "pointmap_path",
                                    "transform_matrix",
                                    "trim3r_triplets",
                                    "w"};
#define KNOWN (sizeof known / sizeof *known)

/* The fields of one object, found in one pass: cJSON would search all of them for each. */
typedef struct field_table {
    const cJSON *item[KNOWN]; /* NULL: missing */
} field_table;

typedef struct reader {
    field_table top, own;
    const cJSON *frame; /* NULL while the top level is read */
    const posed_folder_options *options;
    text_list *remarks;
    const char *remarked[REMARKED_MOST]; /* fields with remarks; the names belong to the text */
    uint32_t remarked_count;
    bool nerfstudio; /* some frame has a depth_file_path */
    char where[64];  /* "frames[3]" */
    char *error;
    size_t error_bytes;
} reader;

static int fail(reader *r, const char *field, const char *what)
{
    return t3r_reason(r->error, r->error_bytes, "%s%s%s: %s", r->where, r->where[0] != '\0' ? ": " : "", field, what);
}

static int by_name(const void *key, const void *entry)
{
    return strcmp(key, *(const char *const *)entry);
}

/* Returns its index in `known`; KNOWN for other fields. */
static size_t number_of(const char *name)
{
    const char *const *found = bsearch(name, known, KNOWN, sizeof *known, by_name);
    return found != NULL ? (size_t)(found - known) : KNOWN;
}

/* Whether an unread field may hold depth, poses, masks or a lens, by its name. */
static bool may_matter(const char *name)
{
    static const char *const parts[] = {"depth",     "disparity", "pose",       "transform",
                                        "extrinsic", "mask",      "confidence", "distort"};
    static const char *const harmless[] = {"applied_transform"}; /* the poses already include it */
    for (size_t i = 0; i < sizeof harmless / sizeof *harmless; i++) {
        if (strcmp(name, harmless[i]) == 0) {
            return false;
        }
    }
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        if (strcasestr(name, parts[i]) != NULL) {
            return true;
        }
    }
    return false;
}

/* Remarks once per name. */
static void tell_unread(reader *r, const char *name)
{
    for (uint32_t i = 0; i < r->remarked_count; i++) {
        if (strcmp(r->remarked[i], name) == 0) {
            return;
        }
    }
    if (r->remarked_count < REMARKED_MOST) {
        r->remarked[r->remarked_count++] = name;
        (void)text_list_add(r->remarks,
                            "%s%s%.100s: this field is not read, though its name says depth, pose, mask or lens",
                            r->where, r->where[0] != '\0' ? ": " : "", name);
    }
}

/* Fills the table; of two equal keys the first counts. */
static void find_fields(reader *r, const cJSON *object, field_table *table)
{
    const cJSON *item;
    *table = (field_table){0};
    cJSON_ArrayForEach(item, object)
    {
        size_t number = number_of(item->string);
        if (number < KNOWN && table->item[number] == NULL) {
            table->item[number] = item;
        } else if (number == KNOWN && may_matter(item->string)) {
            tell_unread(r, item->string);
        }
    }
}

static const cJSON *field(const field_table *table, const char *name)
{
    size_t number = number_of(name);
    assert(number < KNOWN);
    return table->item[number];
}

/* Returns the field of the frame, else of the top level; NULL when neither has it. */
static const cJSON *field_of(const reader *r, const char *name)
{
    const cJSON *item = r->frame == NULL ? NULL : field(&r->own, name);
    return item != NULL ? item : field(&r->top, name);
}

/* Reads a number, NAN when absent; -1 when it is something else or not finite. */
static int read_number(reader *r, const char *name, double *value)
{
    const cJSON *item = field_of(r, name);
    *value = NAN;
    if (item == NULL || cJSON_IsNull(item)) {
        return 0;
    }
    if (!cJSON_IsNumber(item)) {
        return fail(r, name, "not a number");
    }
    if (!isfinite(item->valuedouble)) {
        return fail(r, name, "not finite");
    }
    *value = item->valuedouble;
    return 0;
}

static int read_path(reader *r, const char *name, char **path)
{
    const cJSON *item = field(&r->own, name);
    if (!cJSON_IsString(item)) {
        return fail(r, name, item == NULL ? "missing" : "not a string");
    }
    size_t length = strlen(item->valuestring);
    if (length == 0 || length > MAX_PATH_BYTES) {
        return fail(r, name, length == 0 ? "empty" : "longer than 4096 bytes");
    }
    *path = strdup(item->valuestring);
    return *path != NULL ? 0 : fail(r, name, "out of memory");
}

/* Reads a path, NULL when absent. */
static int read_optional_path(reader *r, const char *name, char **path)
{
    const cJSON *item = field(&r->own, name);
    return item != NULL && !cJSON_IsNull(item) ? read_path(r, name, path) : 0;
}

/* ---- camera ---------------------------------------------------------------------------------------------------- */

static int read_size(reader *r, const char *name, double *value)
{
    if (read_number(r, name, value) != 0) {
        return -1;
    }
    if (!isnan(*value) && !(*value >= 1 && *value <= PICTURE_LARGEST_SIDE && floor(*value) == *value)) {
        return fail(r, name, "not a whole number of pixels from 1 to 16384");
    }
    return 0;
}

static int read_focal(reader *r, const char *name, double *value)
{
    if (read_number(r, name, value) != 0) {
        return -1;
    }
    return !isnan(*value) && !(*value > 0) ? fail(r, name, "not positive") : 0;
}

static int read_angle(reader *r, const char *name, double *value)
{
    if (read_number(r, name, value) != 0) {
        return -1;
    }
    return !isnan(*value) && !(*value > 0 && *value < 3.14159) ? fail(r, name, "not between 0 and pi") : 0;
}

static bool is_true(const reader *r, const char *name)
{
    const cJSON *item = field_of(r, name);
    return cJSON_IsTrue(item) || (cJSON_IsNumber(item) && item->valuedouble != 0);
}

/* Reads the lens type: camera_model as nerfstudio and COLMAP spell it, or instant-ngp's flags. */
static int read_lens(reader *r, bool *fisheye, bool *pinhole)
{
    static const char *const unsupported[] = {"ftheta_p0", "latlong", "equirectangular", "orthographic"};
    for (size_t i = 0; i < sizeof unsupported / sizeof *unsupported; i++) {
        const cJSON *item = field_of(r, unsupported[i]);
        if (item != NULL && !cJSON_IsFalse(item) && !cJSON_IsNull(item)) {
            return fail(r, unsupported[i], "this lens is not supported (pinhole, OPENCV and OPENCV_FISHEYE are)");
        }
    }
    *fisheye = is_true(r, "is_fisheye");
    *pinhole = false;
    const cJSON *model = field_of(r, "camera_model");
    if (model == NULL) {
        return 0;
    }
    if (!cJSON_IsString(model)) {
        return fail(r, "camera_model", "not a string");
    }
    const char *name = model->valuestring;
    if (strcmp(name, "OPENCV_FISHEYE") == 0) {
        *fisheye = true;
    } else if (strcmp(name, "PINHOLE") == 0 || strcmp(name, "SIMPLE_PINHOLE") == 0) {
        *pinhole = !*fisheye;
    } else if (strcmp(name, "OPENCV") != 0 && strcmp(name, "RADIAL") != 0 && strcmp(name, "SIMPLE_RADIAL") != 0) {
        return fail(r, "camera_model",
                    "not one of OPENCV, OPENCV_FISHEYE, PINHOLE, SIMPLE_PINHOLE, RADIAL, SIMPLE_RADIAL");
    }
    return 0;
}

static int read_distortion(reader *r, posed_intrinsics *out)
{
    static const char *const radtan[8] = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
    static const char *const equidistant[4] = {"k1", "k2", "k3", "k4"};
    bool fisheye = false, pinhole = false;
    if (read_lens(r, &fisheye, &pinhole) != 0) {
        return -1;
    }
    const char *const *names = fisheye ? equidistant : radtan;
    int count = pinhole ? 0 : fisheye ? 4 : 8;
    bool any = fisheye;
    for (int i = 0; i < count; i++) {
        double value;
        if (read_number(r, names[i], &value) != 0) {
            return -1;
        }
        out->coefficients[i] = isnan(value) ? 0 : value;
        any = any || out->coefficients[i] != 0;
    }
    out->distortion = !any ? T3R_DISTORTION_NONE : fisheye ? T3R_DISTORTION_FISHEYE : T3R_DISTORTION_RADTAN;
    return 0;
}

static int read_intrinsics(reader *r, posed_intrinsics *out)
{
    if (read_size(r, "w", &out->width) != 0 || read_size(r, "h", &out->height) != 0 ||
        read_focal(r, "fl_x", &out->fx) != 0 || read_focal(r, "fl_y", &out->fy) != 0 ||
        read_number(r, "cx", &out->cx) != 0 || read_number(r, "cy", &out->cy) != 0 ||
        read_angle(r, "camera_angle_x", &out->angle_x) != 0 || read_angle(r, "camera_angle_y", &out->angle_y) != 0) {
        return -1;
    }
    if (isnan(out->fx) && isnan(out->fy) && isnan(out->angle_x) && isnan(out->angle_y) &&
        !r->options->without_intrinsics) {
        return fail(r, "fl_x", "missing, and no camera_angle_x to derive it from");
    }
    return read_distortion(r, out);
}

/* ---- pose ------------------------------------------------------------------------------------------------------ */

static int read_row(reader *r, const cJSON *row, double values[4])
{
    if (!cJSON_IsArray(row) || cJSON_GetArraySize(row) != 4) {
        return fail(r, "transform_matrix", "a row is not 4 numbers");
    }
    const cJSON *item;
    int column = 0;
    cJSON_ArrayForEach(item, row)
    {
        if (!cJSON_IsNumber(item)) {
            return fail(r, "transform_matrix", "an entry is not a finite number");
        }
        values[column++] = item->valuedouble;
    }
    return 0;
}

static int read_pose(reader *r, posed_frame *out)
{
    const cJSON *matrix = field(&r->own, "transform_matrix");
    out->pose = rigid_identity;
    out->posed = matrix != NULL;
    if (matrix == NULL) {
        return r->options->without_poses ? 0 : fail(r, "transform_matrix", "missing");
    }
    int rows = cJSON_IsArray(matrix) ? cJSON_GetArraySize(matrix) : 0;
    if (rows != 3 && rows != 4) {
        return fail(r, "transform_matrix", "not an array of 4 rows");
    }
    double m[16] = {[15] = 1};
    const cJSON *row;
    int y = 0;
    cJSON_ArrayForEach(row, matrix)
    {
        if (read_row(r, row, &m[y]) != 0) {
            return -1;
        }
        y += 4;
    }
    const char *wrong = pose_of_matrix(m, T3R_AXES_OPENGL, &out->pose);
    return wrong == NULL ? 0 : fail(r, "transform_matrix", wrong);
}

/* ---- depth ----------------------------------------------------------------------------------------------------- */

/* Reads depth_path (instant-ngp's name) or depth_file_path (nerfstudio's). */
static int read_depth_path(reader *r, posed_frame *out)
{
    char *other = NULL;
    if (read_optional_path(r, "depth_path", &out->depth) != 0 ||
        read_optional_path(r, "depth_file_path", &other) != 0) {
        return -1;
    }
    if (out->depth == NULL) {
        r->nerfstudio = r->nerfstudio || other != NULL;
        out->depth = other;
        return 0;
    }
    int status = other == NULL || strcmp(out->depth, other) == 0
                     ? 0
                     : fail(r, "depth_file_path", "there is another depth_path too");
    free(other);
    return status;
}

/* Reads one of the two names of the depth unit; NAN when absent. */
static int read_unit(reader *r, const char *name, double *unit)
{
    uint64_t fixed;
    if (read_number(r, name, unit) != 0) {
        return -1;
    }
    return isnan(*unit) || t3r_fixed_depth_unit(*unit, &fixed)
               ? 0
               : fail(r, name, T3R_LIMIT_TEXT("not between 1e-12 and ", T3R_LIMIT_DEPTH_UNIT, ""));
}

/* Reads the scale that nerfstudio has applied to the poses, and applies to its depth when it reads it; 1 if there is no
 * such depth. */
static int read_applied_scale(reader *r, double *scale)
{
    if (read_number(r, "applied_scale", scale) != 0) {
        return -1;
    }
    if (!isnan(*scale) && !(*scale > 0)) {
        return fail(r, "applied_scale", "not positive");
    }
    if (isnan(*scale) || *scale == 1 || !r->nerfstudio) {
        *scale = 1;
    } else {
        (void)text_list_add(r->remarks, "applied_scale: depth is multiplied by %g, as the poses are", *scale);
    }
    return 0;
}

static bool all_depth_is_exr(const posed_folder *folder)
{
    bool all = true, some = false;
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        const char *depth = folder->frames[i].depth;
        some = some || depth != NULL;
        all = all && (depth == NULL || exr_depth_is(depth));
    }
    return all && some;
}

/* Chooses the step for depth in floats, which has none of its own: the user's, else that of integers, else the default.
 * nerfstudio's factor still scales the floats. */
static void settle_exr(reader *r, double integer_unit, posed_folder *out)
{
    out->depth_unit = r->options->depth_unit != 0 ? r->options->depth_unit
                      : !isnan(integer_unit)      ? integer_unit
                                                  : NERFSTUDIO_UNIT;
    out->depth_unit_given = true;
    if (r->nerfstudio && out->exr_length == 0) {
        (void)text_list_add(r->remarks, "depth_unit_scale_factor: missing; depth in OpenEXR is taken as metres");
    }
}

static int read_depth_unit(reader *r, posed_folder *out)
{
    double unit, other, scale;
    if (read_unit(r, "integer_depth_scale", &unit) != 0 || read_unit(r, "depth_unit_scale_factor", &other) != 0 ||
        read_applied_scale(r, &scale) != 0) {
        return -1;
    }
    out->exr_length = isnan(other) ? 0 : other;
    if (scale != 1) {
        out->exr_length = (isnan(other) ? 1 : other) * scale;
    }
    if (all_depth_is_exr(out)) {
        settle_exr(r, unit, out);
        return 0;
    }
    if (!isnan(unit) && !isnan(other) && unit != other) {
        return fail(r, "depth_unit_scale_factor", "not the integer_depth_scale that is there too");
    }
    unit = isnan(unit) ? other : unit;
    for (uint32_t i = 0; isnan(unit) && i < out->frame_count; i++) {
        if (out->frames[i].depth == NULL) {
            continue;
        }
        if (r->options->depth_unit != 0) {
            unit = r->options->depth_unit;
            scale = 1; /* it is in world units */
            break;
        }
        if (!r->nerfstudio) {
            return fail(r, "integer_depth_scale", "missing, but frames have a depth_path");
        }
        unit = NERFSTUDIO_UNIT;
        (void)text_list_add(r->remarks,
                            "depth_unit_scale_factor: missing; a step of depth is taken as %g, nerfstudio's default",
                            NERFSTUDIO_UNIT);
    }
    uint64_t fixed;
    out->depth_unit = isnan(unit) ? 0.001 : unit * scale;
    out->depth_unit_given = !isnan(unit);
    if (!t3r_fixed_depth_unit(out->depth_unit, &fixed)) {
        return fail(
            r, "applied_scale",
            T3R_LIMIT_TEXT("it makes steps of depth that are not between 1e-12 and ", T3R_LIMIT_DEPTH_UNIT, ""));
    }
    return 0;
}

/* ---- the file -------------------------------------------------------------------------------------------------- */

/* Reads all of a frame but its picture's name. */
static int read_fields(reader *r, posed_frame *frame)
{
    if (read_depth_path(r, frame) != 0 || read_optional_path(r, "mask_path", &frame->mask) != 0 ||
        read_optional_path(r, "pointmap_path", &frame->pointmap) != 0 ||
        read_optional_path(r, "confidence_path", &frame->confidence) != 0) {
        return -1;
    }
    if (frame->confidence != NULL && frame->pointmap == NULL) {
        return fail(r, "confidence_path", "there is no pointmap_path");
    }
    if (frame->depth != NULL && frame->pointmap != NULL) {
        return fail(r, "pointmap_path", "there is a depth_path too");
    }
    return read_pose(r, frame) != 0 ? -1 : read_intrinsics(r, &frame->intrinsics);
}

static int read_frames(reader *r, posed_folder *out)
{
    const cJSON *frames = field(&r->top, "frames");
    if (!cJSON_IsArray(frames)) {
        return fail(r, "frames", frames == NULL ? "missing" : "not an array");
    }
    int count = cJSON_GetArraySize(frames);
    if (count == 0 || count > T3R_LIMIT_FRAMES) {
        return fail(r, "frames", count == 0 ? "empty" : T3R_LIMIT_TEXT("more than ", T3R_LIMIT_FRAMES, ""));
    }
    out->frames = calloc((size_t)count, sizeof *out->frames);
    if (out->frames == NULL) {
        return fail(r, "frames", "out of memory");
    }
    cJSON_ArrayForEach(r->frame, frames)
    {
        posed_frame *frame = &out->frames[out->frame_count++];
        snprintf(r->where, sizeof r->where, "frames[%u]", out->frame_count - 1);
        if (!cJSON_IsObject(r->frame)) {
            return t3r_reason(r->error, r->error_bytes, "%s: not an object", r->where);
        }
        find_fields(r, r->frame, &r->own);
        if (read_path(r, "file_path", &frame->image) != 0) {
            return -1;
        }
        if (read_fields(r, frame) != 0) {
            rejected_mark(frame, "%s: %s", frame->image, r->error);
            r->error[0] = '\0';
        }
    }
    r->frame = NULL;
    r->where[0] = '\0';
    return 0;
}

static bool frame_index(const cJSON *item, uint32_t count, uint32_t *index)
{
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0 && item->valuedouble < count) ||
        floor(item->valuedouble) != item->valuedouble) {
        return false;
    }
    *index = (uint32_t)item->valuedouble;
    return true;
}

static int read_triplets(reader *r, posed_folder *out)
{
    const cJSON *triplets = field(&r->top, "trim3r_triplets");
    if (triplets == NULL) {
        return 0;
    }
    if (!cJSON_IsArray(triplets)) {
        return fail(r, "trim3r_triplets", "not an array");
    }
    int count = cJSON_GetArraySize(triplets);
    if (count > T3R_LIMIT_TRIPLETS) {
        return fail(r, "trim3r_triplets", T3R_LIMIT_TEXT("more than ", T3R_LIMIT_TRIPLETS, ""));
    }
    out->triplets = calloc((size_t)count + 1, sizeof *out->triplets);
    if (out->triplets == NULL) {
        return fail(r, "trim3r_triplets", "out of memory");
    }
    const cJSON *item;
    cJSON_ArrayForEach(item, triplets)
    {
        t3r_triplet *t = &out->triplets[out->triplet_count];
        snprintf(r->where, sizeof r->where, "trim3r_triplets[%u]", out->triplet_count);
        const cJSON *context = cJSON_GetObjectItemCaseSensitive(item, "context");
        if (!cJSON_IsArray(context) || cJSON_GetArraySize(context) != 2 ||
            !frame_index(cJSON_GetArrayItem(context, 0), out->frame_count, &t->context[0]) ||
            !frame_index(cJSON_GetArrayItem(context, 1), out->frame_count, &t->context[1])) {
            return fail(r, "context", "not two frame indices");
        }
        if (!frame_index(cJSON_GetObjectItemCaseSensitive(item, "target"), out->frame_count, &t->target)) {
            return fail(r, "target", "not a frame index");
        }
        out->triplet_count++;
    }
    r->where[0] = '\0';
    return 0;
}

int transforms_json_parse(const char *text, size_t bytes, const posed_folder_options *options, posed_folder *out,
                          char *error, size_t error_bytes)
{
    static const posed_folder_options strict = {0};
    memset(out, 0, sizeof *out);
    cJSON *root = json_parse_python(text, bytes, error, error_bytes);
    if (root == NULL) {
        return -1;
    }
    reader r = {.options = options != NULL ? options : &strict,
                .remarks = &out->remarks,
                .error = error,
                .error_bytes = error_bytes};
    int status;
    if (!cJSON_IsObject(root)) {
        status = t3r_reason(error, error_bytes, "byte 0: not a JSON object");
    } else {
        find_fields(&r, root, &r.top);
        status = read_frames(&r, out) != 0 || read_depth_unit(&r, out) != 0 || read_triplets(&r, out) != 0 ? -1 : 0;
    }
    cJSON_Delete(root);
    return status;
}
