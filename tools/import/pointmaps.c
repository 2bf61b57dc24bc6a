#include "import/pointmaps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "file_bytes.h"
#include "import/npy.h"
#include "import/npz.h"
#include "import/posed_frame.h"
#include "posing/quaternion.h"
#include "reason.h"
#include "trim3r.h"

#define MOST_BYTES ((size_t)1 << 31)
#define NAMES 5

/* What an array is, and its names in a .npz. */
typedef struct array_role {
    const char *names[NAMES]; /* NULL behind the last */
    uint32_t dimensions;      /* of one view */
} array_role;

static const array_role points_role = {{"pts3d", "world_points", "points", "pointmap"}, 3},
                        confidence_role = {{"conf", "confs", "world_points_conf", "confidence"}, 2},
                        poses_role = {{"poses"}, 2}, extrinsics_role = {{"extrinsics", "extrinsic"}, 2},
                        intrinsics_role = {{"intrinsics", "intrinsic"}, 2}, focals_role = {{"focals"}, 0};

/* An array of a file: one a view, `count` of them. */
typedef struct stack {
    const char *name;
    npy_array array;
    uint8_t *bytes; /* owned, or NULL */
    uint32_t count;
    const uint32_t *shape; /* of one view */
} stack;

static int fail(const stack *s, const char *what, char *error, size_t error_bytes)
{
    char shape[64];
    npy_shape_text(&s->array, shape, sizeof shape);
    return t3r_reason(error, error_bytes, "array %s of %s: %s", s->name, shape, what);
}

/* Where a number stands, "[1, 20, 30, 2]". */
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

/* The array's dimensions as views and what one view has: leading ones beyond that are dropped. */
static int understand(stack *s, const array_role *role, char *error, size_t error_bytes)
{
    uint32_t first = 0, end = s->array.dimensions;
    while (role->dimensions == 0 && end > 1 && s->array.shape[end - 1] == 1) {
        end--; /* a number a view may stand as N x 1 */
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
    for (size_t i = 0; i < s->array.count; i++) {
        double value = npy_value(&s->array, i);
        if (!isfinite(value)) {
            char place[64];
            place_text(&s->array, i, place, sizeof place);
            return t3r_reason(error, error_bytes, "array %s: [%s] is %s", s->name, place,
                              isnan(value) ? "not a number" : "infinite");
        }
    }
    return 0;
}

/* 1, 0 when the archive has none of the names, -1 with a reason. */
static int find(npz *archive, const array_role *role, stack *out, char *error, size_t error_bytes)
{
    *out = (stack){0};
    for (int i = 0; i < NAMES && role->names[i] != NULL; i++) {
        size_t count;
        char why[256];
        out->name = role->names[i];
        int found = npz_read(archive, out->name, MOST_BYTES, &out->bytes, &count, why, sizeof why);
        if (found < 0 || (found == 1 && npy_parse(out->bytes, count, &out->array, why, sizeof why) != 0)) {
            return t3r_reason(error, error_bytes, "array %s: %s", out->name, why);
        }
        if (found == 1) {
            return understand(out, role, error, error_bytes) == 0 ? 1 : -1;
        }
    }
    return 0;
}

/* ---- what they become ------------------------------------------------------------------------------------------- */

static float *floats(const npy_array *array)
{
    float *out = malloc(array->count * sizeof *out);
    for (size_t i = 0; i < array->count && out != NULL; i++) {
        out[i] = (float)npy_value(array, i);
    }
    return out;
}

static int take_points(const stack *s, pointmaps *out, char *error, size_t error_bytes)
{
    if (s->array.item_bytes != 4) {
        return fail(s, "float64, but points are float32", error, error_bytes);
    }
    if (s->shape[2] != 3) {
        return fail(s, "the last dimension is not 3", error, error_bytes);
    }
    if (s->count > POINTMAPS_MOST) {
        return fail(s, "more than 1000 views", error, error_bytes);
    }
    if (s->shape[0] < 2 || s->shape[1] < 2 || s->shape[0] > T3R_MAX_SIDE || s->shape[1] > T3R_MAX_SIDE) {
        return fail(s, "a side is not 2 to 4096 pixels", error, error_bytes);
    }
    out->count = s->count;
    out->height = s->shape[0];
    out->width = s->shape[1];
    out->points = floats(&s->array);
    return out->points != NULL ? 0 : t3r_reason(error, error_bytes, "out of memory");
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
    out->confidence = floats(&s->array);
    return out->confidence != NULL ? 0 : t3r_reason(error, error_bytes, "out of memory");
}

static int check_count(const stack *s, const pointmaps *out, char *error, size_t error_bytes)
{
    return s->count == out->count ? 0 : fail(s, "not as many as there are pointmaps", error, error_bytes);
}

/* poses as they are, extrinsics inverted */
static int take_poses(const stack *s, bool inverse, pointmaps *out, char *error, size_t error_bytes)
{
    uint32_t rows = s->shape[0];
    if (check_count(s, out, error, error_bytes) != 0) {
        return -1;
    }
    if (s->shape[1] != 4 || (rows != 4 && (rows != 3 || !inverse))) {
        return fail(s, inverse ? "not 3x4 or 4x4 matrices" : "not 4x4 matrices", error, error_bytes);
    }
    out->poses = malloc(out->count * sizeof *out->poses);
    if (out->poses == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    for (uint32_t v = 0; v < out->count; v++) {
        motion m;
        double quaternion[4];
        size_t at = (size_t)v * rows * 4;
        for (uint32_t i = 0; i < 12; i++) {
            double value = npy_value(&s->array, at + i);
            *(i % 4 == 3 ? &m.t[i / 4] : &m.r[i / 4 * 3 + i % 4]) = value;
            if (i % 4 == 3 && !(fabs(value) < 0x1p30)) {
                return fail(s, "a position is 2^30 or more", error, error_bytes);
            }
        }
        for (uint32_t i = 12; i < rows * 4; i++) {
            if (npy_value(&s->array, at + i) != (i == 15 ? 1 : 0)) {
                return fail(s, "the last row is not 0 0 0 1", error, error_bytes);
            }
        }
        const char *wrong = quaternion_of(m.r, quaternion);
        if (wrong != NULL) {
            return fail(s, wrong, error, error_bytes);
        }
        out->poses[v] = inverse ? motion_inverse(&m) : m;
    }
    return 0;
}

static int take_intrinsics(const stack *s, bool matrices, pointmaps *out, char *error, size_t error_bytes)
{
    if (check_count(s, out, error, error_bytes) != 0) {
        return -1;
    }
    if (matrices && (s->shape[0] != 3 || s->shape[1] != 3)) {
        return fail(s, "not 3x3 matrices", error, error_bytes);
    }
    out->intrinsics = malloc(out->count * sizeof *out->intrinsics);
    if (out->intrinsics == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    for (uint32_t v = 0; v < out->count; v++) {
        double *k = out->intrinsics[v];
        if (matrices) {
            static const int places[4] = {0, 4, 2, 5}, zeros[4] = {1, 3, 6, 7};
            for (int i = 0; i < 4; i++) {
                k[i] = npy_value(&s->array, 9 * (size_t)v + (size_t)places[i]);
                if (npy_value(&s->array, 9 * (size_t)v + (size_t)zeros[i]) != 0) {
                    return fail(s, "a skew, or an entry where a camera matrix has none", error, error_bytes);
                }
            }
        } else {
            k[0] = k[1] = npy_value(&s->array, v);
            k[2] = out->width / 2.0; /* where DUSt3R has it */
            k[3] = out->height / 2.0;
        }
        if (!(k[0] > 0 && k[1] > 0)) {
            return fail(s, "a focal length is not positive", error, error_bytes);
        }
    }
    return 0;
}

/* ---- files ------------------------------------------------------------------------------------------------------ */

static int parse_npz(npz *archive, pointmaps *out, char *error, size_t error_bytes)
{
    static const struct {
        const array_role *role;
        enum { POINTS, CONFIDENCE, POSES, EXTRINSICS, INTRINSICS, FOCALS } what;
    } steps[] = {{&points_role, POINTS},         {&confidence_role, CONFIDENCE}, {&poses_role, POSES},
                 {&extrinsics_role, EXTRINSICS}, {&intrinsics_role, INTRINSICS}, {&focals_role, FOCALS}};
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        stack s;
        if ((steps[i].what == EXTRINSICS && out->poses != NULL) ||
            (steps[i].what == FOCALS && out->intrinsics != NULL)) {
            continue;
        }
        int status = find(archive, steps[i].role, &s, error, error_bytes);
        if (status == 1) {
            switch (steps[i].what) {
            case POINTS:
                status = take_points(&s, out, error, error_bytes);
                break;
            case CONFIDENCE:
                status = take_confidence(&s, out, error, error_bytes);
                break;
            case POSES:
            case EXTRINSICS:
                status = take_poses(&s, steps[i].what == EXTRINSICS, out, error, error_bytes);
                break;
            default:
                status = take_intrinsics(&s, steps[i].what == INTRINSICS, out, error, error_bytes);
                break;
            }
        } else if (status == 0 && steps[i].what == POINTS) {
            status = t3r_reason(error, error_bytes, "no array pts3d, world_points, points or pointmap");
        }
        free(s.bytes);
        if (status != 0) {
            return -1;
        }
    }
    return 0;
}

static int parse_npy(const uint8_t *bytes, size_t count, const array_role *role, stack *out, char *error,
                     size_t error_bytes)
{
    *out = (stack){.name = role->names[0]};
    return npy_parse(bytes, count, &out->array, error, error_bytes) == 0 &&
                   understand(out, role, error, error_bytes) == 0
               ? 0
               : -1;
}

int pointmaps_parse(const uint8_t *bytes, size_t count, pointmaps *out, char *error, size_t error_bytes)
{
    *out = (pointmaps){0};
    if (count >= 2 && memcmp(bytes, "PK", 2) == 0) {
        npz *archive = npz_open(bytes, count, error, error_bytes);
        int status = archive != NULL ? parse_npz(archive, out, error, error_bytes) : -1;
        npz_close(archive);
        return status;
    }
    if (count >= 6 && memcmp(bytes, "\x93NUMPY", 6) == 0) {
        stack s;
        return parse_npy(bytes, count, &points_role, &s, error, error_bytes) == 0
                   ? take_points(&s, out, error, error_bytes)
                   : -1;
    }
    return t3r_reason(error, error_bytes, "neither .npz nor .npy");
}

static int add_confidence(const char *path, pointmaps *out, char *error, size_t error_bytes)
{
    size_t count;
    char why[512];
    stack s;
    uint8_t *bytes = t3r_file_bytes(path, MOST_BYTES, &count, error, error_bytes);
    if (bytes == NULL) {
        return -1;
    }
    free(out->confidence);
    out->confidence = NULL;
    int status = parse_npy(bytes, count, &confidence_role, &s, why, sizeof why) == 0 &&
                         take_confidence(&s, out, why, sizeof why) == 0
                     ? 0
                     : t3r_reason(error, error_bytes, "%s: %s", path, why);
    free(bytes);
    return status;
}

int pointmaps_read(const char *path, const char *confidence, pointmaps *out, char *error, size_t error_bytes)
{
    size_t count;
    char why[512];
    *out = (pointmaps){0};
    uint8_t *bytes = t3r_file_bytes(path, MOST_BYTES, &count, error, error_bytes);
    if (bytes == NULL) {
        return -1;
    }
    int status = pointmaps_parse(bytes, count, out, why, sizeof why) == 0
                     ? 0
                     : t3r_reason(error, error_bytes, "%s: %s", path, why);
    free(bytes);
    return status == 0 && confidence != NULL ? add_confidence(confidence, out, error, error_bytes) : status;
}

void pointmaps_free(pointmaps *maps)
{
    free(maps->points);
    free(maps->confidence);
    free(maps->poses);
    free(maps->intrinsics);
    *maps = (pointmaps){0};
}

void pointmaps_depth(const pointmaps *maps, uint32_t index, const motion *camera, double least, float *depth)
{
    size_t pixels = (size_t)maps->width * maps->height;
    const float *points = maps->points + 3 * pixels * index;
    const float *confidence = maps->confidence != NULL ? maps->confidence + pixels * index : NULL;
    for (size_t i = 0; i < pixels; i++) {
        const float *p = points + 3 * i;
        double z = 0;
        for (int k = 0; k < 3; k++) {
            z += camera->r[3 * k + 2] * (p[k] - camera->t[k]);
        }
        depth[i] = confidence != NULL && confidence[i] < least ? 0 : (float)z;
    }
}
