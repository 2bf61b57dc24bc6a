/* SPDX-License-Identifier: Apache-2.0 */
#include "import/pointmaps/pointmaps.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geometry/pose_matrix.h"
#include "geometry/quaternion.h"
#include "host/reason.h"
#include "import/pointmaps/array_file.h"
#include "mcap/reader_limits.h"

#define NAMES 5
#define SMALL_MOST (16u * T3R_LIMIT_VIEWS_OF_POINTS) /* most numbers of all poses, or of all intrinsics */

/* The meaning of an array, and its names in a .npz. */
typedef struct array_role {
    const char *names[NAMES]; /* ends with NULL */
    uint32_t dimensions;      /* of one view's array */
} array_role;

static const array_role points_role = {{"pts3d", "world_points", "points", "pointmap"}, 3},
                        confidence_role = {{"conf", "confs", "world_points_conf", "confidence"}, 2},
                        poses_role = {{"poses"}, 2}, extrinsics_role = {{"extrinsics", "extrinsic"}, 2},
                        intrinsics_role = {{"intrinsics", "intrinsic"}, 2}, focals_role = {{"focals"}, 0};

/* An array of a file: `count` views. */
typedef struct stack {
    const char *name;
    array_stream *stream; /* owned */
    npy_array array;
    uint32_t count;
    const uint32_t *shape; /* shape of one view */
} stack;

/* The source of the views. */
struct pointmaps_input {
    char *path, *confidence_path; /* NULL: read from memory; part of the same file */
    array_file *file, *confidence_file;
    stack points, confidence;
};

static int fail(const stack *s, const char *what, char *error, size_t error_bytes)
{
    char shape[64];
    npy_shape_text(&s->array, shape, sizeof shape);
    return t3r_reason(error, error_bytes, "array %s of %s: %s", s->name, shape, what);
}

/* Writes the place of a number, such as "[1, 20, 30, 2]". */
static void place_text(const npy_array *array, size_t index, char *text, size_t bytes)
{
    uint32_t at[NPY_MOST_DIMENSIONS];
    size_t used = 0;
    for (uint32_t d = array->dimensions; d-- > 0;) {
        at[d] = (uint32_t)(index % array->shape[d]);
        index /= array->shape[d];
    }
    text[0] = '\0';
    for (uint32_t d = 0; d < array->dimensions && used < bytes; d++) {
        used += (size_t)snprintf(text + used, bytes - used, "%s%u", d > 0 ? ", " : "", at[d]);
    }
}

/* Splits the array's dimensions into views and one view's shape; drops extra leading dimensions of 1. */
static int understand(stack *s, const array_role *role, char *error, size_t error_bytes)
{
    uint32_t first = 0, end = s->array.dimensions;
    while (role->dimensions == 0 && end > 1 && s->array.shape[end - 1] == 1) {
        end--; /* one number per view may have the shape N x 1 */
    }
    while (end - first > role->dimensions + 1 && s->array.shape[first] == 1) {
        first++;
    }
    uint32_t left = end - first;
    if (left < role->dimensions || left > role->dimensions + 1) {
        return fail(s, "not so many dimensions", error, error_bytes);
    }
    s->count = left == role->dimensions ? 1 : s->array.shape[first];
    s->shape = &s->array.shape[first + (left - role->dimensions)];
    return 0;
}

/* Reports that number `index` of the array is not finite. */
static int refuse_number(const stack *s, size_t index, double value, char *error, size_t error_bytes)
{
    char place[64];
    place_text(&s->array, index, place, sizeof place);
    return t3r_reason(error, error_bytes, "array %s: [%s] is %s", s->name, place,
                      isnan(value) ? "not a number" : "infinite");
}

/* Finds the array of a role. Returns 1; 0 when the file has none of the names; -1 with a reason. */
static int find(array_file *file, const array_role *role, stack *out, char *error, size_t error_bytes)
{
    *out = (stack){0};
    for (int i = 0; i < NAMES && role->names[i] != NULL; i++) {
        char why[256];
        out->name = role->names[i];
        int found = array_file_find(file, out->name, &out->stream, why, sizeof why);
        if (found < 0) {
            return t3r_reason(error, error_bytes, "array %s: %s", out->name, why);
        }
        if (found == 1) {
            out->array = *array_stream_header(out->stream);
            return understand(out, role, error, error_bytes) == 0 ? 1 : -1;
        }
    }
    return 0;
}

/* Reads all numbers of a small array, which must be finite; NULL with a reason. */
static double *read_small(const stack *s, char *error, size_t error_bytes)
{
    double *out = s->array.count <= SMALL_MOST ? malloc(SMALL_MOST * sizeof *out) : NULL;
    if (out == NULL) {
        fail(s, s->array.count <= SMALL_MOST ? "out of memory" : "too large", error, error_bytes);
        return NULL;
    }
    const char *wrong = array_stream_doubles(s->stream, 0, s->array.count, out);
    int status = wrong == NULL ? 0 : t3r_reason(error, error_bytes, "array %s: %s", s->name, wrong);
    for (size_t i = 0; i < s->array.count && status == 0; i++) {
        status = isfinite(out[i]) ? 0 : refuse_number(s, i, out[i], error, error_bytes);
    }
    if (status != 0) {
        free(out);
        out = NULL;
    }
    return out;
}

/* ---- conversion ------------------------------------------------------------------------------------------------- */

static int take_points(const stack *s, pointmaps *out, char *error, size_t error_bytes)
{
    if (s->array.item_bytes != 4) {
        return fail(s, "float64, but points are float32", error, error_bytes);
    }
    if (s->shape[2] != 3) {
        return fail(s, "the last dimension is not 3", error, error_bytes);
    }
    if (s->count > T3R_LIMIT_VIEWS_OF_POINTS) {
        return fail(s, T3R_LIMIT_TEXT("more than ", T3R_LIMIT_VIEWS_OF_POINTS, " views"), error, error_bytes);
    }
    if (s->shape[0] < 2 || s->shape[1] < 2 || s->shape[0] > T3R_MAX_SIDE || s->shape[1] > T3R_MAX_SIDE) {
        return fail(s, "a side is not 2 to 4096 pixels", error, error_bytes);
    }
    out->count = s->count;
    out->height = s->shape[0];
    out->width = s->shape[1];
    return 0;
}

static int take_confidence(const stack *s, pointmaps *out, char *error, size_t error_bytes)
{
    if (s->count != out->count || s->shape[0] != out->height || s->shape[1] != out->width) {
        char shape[64];
        npy_shape_text(&s->array, shape, sizeof shape);
        return t3r_reason(error, error_bytes, "array %s of %s: the points are %u views of %ux%u rows and columns",
                          s->name, shape, out->count, out->height, out->width);
    }
    if (s->array.item_bytes != 4) {
        return fail(s, "float64, but confidence is float32", error, error_bytes);
    }
    out->has_confidence = true;
    return 0;
}

static int check_count(const stack *s, const pointmaps *out, char *error, size_t error_bytes)
{
    return s->count == out->count ? 0 : fail(s, "not as many as there are pointmaps", error, error_bytes);
}

/* Converts poses; extrinsics are inverted. */
static int check_poses(const stack *s, bool inverse, const pointmaps *out, char *error, size_t error_bytes)
{
    uint32_t rows = s->shape[0];
    if (check_count(s, out, error, error_bytes) != 0) {
        return -1;
    }
    if (s->shape[1] != 4 || (rows != 4 && (rows != 3 || !inverse))) {
        return fail(s, inverse ? "not 3x4 or 4x4 matrices" : "not 4x4 matrices", error, error_bytes);
    }
    return 0;
}

static int take_poses(const stack *s, bool inverse, const double *numbers, pointmaps *out, char *error,
                      size_t error_bytes)
{
    uint32_t rows = s->shape[0];
    out->poses = malloc(out->count * sizeof *out->poses);
    if (out->poses == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    for (uint32_t v = 0; v < out->count; v++) {
        double matrix[16] = {[15] = 1};
        rigid pose;
        memcpy(matrix, numbers + (size_t)v * rows * 4, rows * 4 * sizeof *matrix);
        const char *wrong = pose_of_matrix(matrix, T3R_AXES_OPENCV, &pose);
        if (wrong != NULL) {
            return fail(s, wrong, error, error_bytes);
        }
        out->poses[v] = inverse ? rigid_inverse(&pose) : pose;
    }
    return 0;
}

static int check_intrinsics(const stack *s, bool matrices, const pointmaps *out, char *error, size_t error_bytes)
{
    if (check_count(s, out, error, error_bytes) != 0) {
        return -1;
    }
    return !matrices || (s->shape[0] == 3 && s->shape[1] == 3) ? 0 : fail(s, "not 3x3 matrices", error, error_bytes);
}

static int take_intrinsics(const stack *s, bool matrices, const double *numbers, pointmaps *out, char *error,
                           size_t error_bytes)
{
    out->intrinsics = malloc(out->count * sizeof *out->intrinsics);
    if (out->intrinsics == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    for (uint32_t v = 0; v < out->count; v++) {
        double *k = out->intrinsics[v];
        if (matrices) {
            static const int places[4] = {0, 4, 2, 5}, zeros[4] = {1, 3, 6, 7};
            for (int i = 0; i < 4; i++) {
                k[i] = numbers[9 * (size_t)v + (size_t)places[i]];
                if (numbers[9 * (size_t)v + (size_t)zeros[i]] != 0) {
                    return fail(s, "a skew, or an entry where a camera matrix has none", error, error_bytes);
                }
            }
        } else {
            k[0] = k[1] = numbers[v];
            k[2] = out->width / 2.0; /* as in DUSt3R */
            k[3] = out->height / 2.0;
        }
        if (!(k[0] > 0 && k[1] > 0)) {
            return fail(s, "a focal length is not positive", error, error_bytes);
        }
    }
    return 0;
}

/* ---- files ------------------------------------------------------------------------------------------------------ */

typedef enum small_role { POSES, EXTRINSICS, INTRINSICS, FOCALS } small_role;

static int take_small(const stack *s, small_role what, pointmaps *out, char *error, size_t error_bytes)
{
    bool poses = what == POSES || what == EXTRINSICS;
    int status = poses ? check_poses(s, what == EXTRINSICS, out, error, error_bytes)
                       : check_intrinsics(s, what == INTRINSICS, out, error, error_bytes);
    double *numbers = status == 0 ? read_small(s, error, error_bytes) : NULL;
    if (numbers == NULL) {
        return -1;
    }
    status = poses ? take_poses(s, what == EXTRINSICS, numbers, out, error, error_bytes)
                   : take_intrinsics(s, what == INTRINSICS, numbers, out, error, error_bytes);
    free(numbers);
    return status;
}

static int read_cameras(array_file *file, pointmaps *out, char *error, size_t error_bytes)
{
    static const struct {
        const array_role *role;
        small_role what;
    } steps[] = {
        {&poses_role, POSES}, {&extrinsics_role, EXTRINSICS}, {&intrinsics_role, INTRINSICS}, {&focals_role, FOCALS}};
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        stack s;
        if ((steps[i].what == EXTRINSICS && out->poses != NULL) ||
            (steps[i].what == FOCALS && out->intrinsics != NULL)) {
            continue;
        }
        int status = find(file, steps[i].role, &s, error, error_bytes);
        status = status == 1 ? take_small(&s, steps[i].what, out, error, error_bytes) : status;
        array_stream_close(s.stream);
        if (status != 0) {
            return -1;
        }
    }
    return 0;
}

static int read_headers(pointmaps *out, char *error, size_t error_bytes)
{
    struct pointmaps_input *in = out->input;
    int status = find(in->file, &points_role, &in->points, error, error_bytes);
    if (status == 0) {
        status = t3r_reason(error, error_bytes, "no array pts3d, world_points, points or pointmap");
    }
    if (status < 0 || take_points(&in->points, out, error, error_bytes) != 0) {
        return -1;
    }
    if (array_file_is_lone(in->file)) {
        return 0;
    }
    status = find(in->file, &confidence_role, &in->confidence, error, error_bytes);
    status = status == 1 ? take_confidence(&in->confidence, out, error, error_bytes) : status;
    return status == 0 ? read_cameras(in->file, out, error, error_bytes) : -1;
}

static int open_input(pointmaps *out, char *error, size_t error_bytes)
{
    *out = (pointmaps){.input = calloc(1, sizeof *out->input)};
    return out->input != NULL ? 0 : t3r_reason(error, error_bytes, "out of memory");
}

int pointmaps_parse(const uint8_t *bytes, size_t count, pointmaps *out, char *error, size_t error_bytes)
{
    if (open_input(out, error, error_bytes) != 0) {
        return -1;
    }
    out->input->file = array_file_parse(bytes, count, error, error_bytes);
    return out->input->file != NULL ? read_headers(out, error, error_bytes) : -1;
}

/* Opens a confidence file, which replaces the confidence in the .npz. */
static int open_confidence(const char *path, pointmaps *out, char *error, size_t error_bytes)
{
    struct pointmaps_input *in = out->input;
    char why[512];
    in->confidence_path = strdup(path);
    in->confidence_file = array_file_open(path, error, error_bytes);
    if (in->confidence_file == NULL || in->confidence_path == NULL) {
        return in->confidence_file == NULL ? -1 : t3r_reason(error, error_bytes, "out of memory");
    }
    array_stream_close(in->confidence.stream);
    in->confidence = (stack){0};
    if (!array_file_is_lone(in->confidence_file)) {
        return t3r_reason(error, error_bytes, "%s: not a NumPy array (.npy)", path);
    }
    return find(in->confidence_file, &confidence_role, &in->confidence, why, sizeof why) == 1 &&
                   take_confidence(&in->confidence, out, why, sizeof why) == 0
               ? 0
               : t3r_reason(error, error_bytes, "%s: %s", path, why);
}

int pointmaps_open(const char *path, const char *confidence, pointmaps *out, char *error, size_t error_bytes)
{
    char why[512];
    if (open_input(out, error, error_bytes) != 0) {
        return -1;
    }
    out->input->file = array_file_open(path, error, error_bytes);
    if (out->input->file == NULL) {
        return -1;
    }
    out->input->path = strdup(path);
    int status =
        out->input->path != NULL ? read_headers(out, why, sizeof why) : t3r_reason(why, sizeof why, "out of memory");
    if (status != 0) {
        return t3r_reason(error, error_bytes, "%s: %s", path, why);
    }
    return confidence != NULL ? open_confidence(confidence, out, error, error_bytes) : 0;
}

/* ---- views ------------------------------------------------------------------------------------------------------ */

static int read_view(const stack *s, uint32_t index, size_t numbers, float **out, char *error, size_t error_bytes)
{
    if (*out == NULL && (*out = malloc(numbers * sizeof **out)) == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    const char *wrong = array_stream_floats(s->stream, numbers * index, numbers, *out);
    if (wrong != NULL) {
        return t3r_reason(error, error_bytes, "array %s: %s", s->name, wrong);
    }
    for (size_t i = 0; i < numbers; i++) {
        if (!isfinite((*out)[i])) {
            return refuse_number(s, numbers * index + i, (*out)[i], error, error_bytes);
        }
    }
    return 0;
}

int pointmaps_read(pointmaps *maps, uint32_t index, char *error, size_t error_bytes)
{
    const struct pointmaps_input *in = maps->input;
    const char *path = in->path;
    size_t pixels = (size_t)maps->width * maps->height;
    char why[512];
    int status = read_view(&in->points, index, 3 * pixels, &maps->points, why, sizeof why);
    if (status == 0 && maps->has_confidence) {
        path = in->confidence_path != NULL ? in->confidence_path : path;
        status = read_view(&in->confidence, index, pixels, &maps->confidence, why, sizeof why);
    }
    return status == 0
               ? 0
               : t3r_reason(error, error_bytes, "%s%s%s", path != NULL ? path : "", path != NULL ? ": " : "", why);
}

void pointmaps_forget(pointmaps *maps)
{
    free(maps->points);
    free(maps->confidence);
    maps->points = maps->confidence = NULL;
}

void pointmaps_free(pointmaps *maps)
{
    struct pointmaps_input *in = maps->input;
    pointmaps_forget(maps);
    free(maps->poses);
    free(maps->intrinsics);
    if (in != NULL) {
        array_stream_close(in->points.stream);
        array_stream_close(in->confidence.stream);
        array_file_close(in->file);
        array_file_close(in->confidence_file);
        free(in->path);
        free(in->confidence_path);
        free(in);
    }
    *maps = (pointmaps){0};
}

void pointmaps_depth(const pointmaps *maps, const rigid *camera, double least, float *depth)
{
    double rotation[9];
    quaternion_matrix(camera->rotation, rotation);
    size_t pixels = (size_t)maps->width * maps->height;
    for (size_t i = 0; i < pixels; i++) {
        const float *p = maps->points + 3 * i;
        double z = 0;
        for (int k = 0; k < 3; k++) {
            z += rotation[3 * k + 2] * (p[k] - camera->position[k]);
        }
        depth[i] = maps->confidence != NULL && maps->confidence[i] < least ? 0 : (float)z;
    }
}
