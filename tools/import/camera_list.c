/* SPDX-License-Identifier: Apache-2.0 */
#include "import/camera_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry/pose_matrix.h"
#include "host/reason.h"
#include "import/frames/rejected.h"
#include "mcap/reader_limits.h"

#define PATH "camera_path"

bool camera_list_is(const cJSON *root)
{
    return cJSON_IsArray(root) || cJSON_GetObjectItemCaseSensitive(root, PATH) != NULL;
}

/* Reads a number; NAN where there is none. */
static double number_of(const cJSON *object, const char *name)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, name);
    return cJSON_IsNumber(item) ? item->valuedouble : NAN;
}

/* Reads an array of numbers. */
static bool read_row(const cJSON *array, int count, double *out)
{
    const cJSON *item;
    bool good = cJSON_IsArray(array) && cJSON_GetArraySize(array) == count;
    cJSON_ArrayForEach(item, array)
    {
        good = good && cJSON_IsNumber(item);
        if (good) {
            *out++ = item->valuedouble;
        }
    }
    return good;
}

/* Reads the sides of a picture; NAN where one is missing or no side. */
static void read_sides(const cJSON *object, const char *width, const char *height, posed_intrinsics *out)
{
    out->width = number_of(object, width);
    out->height = number_of(object, height);
    out->width = out->width >= 1 && out->width <= UINT16_MAX ? floor(out->width) : NAN;
    out->height = out->height >= 1 && out->height <= UINT16_MAX ? floor(out->height) : NAN;
}

/* ---- nerfstudio ------------------------------------------------------------------------------------------------ */

/* Reads a camera of a path: fov is the vertical angle in degrees, and the matrix has the axes of OpenGL. Returns NULL,
 * or what is wrong. */
static const char *read_step(const cJSON *item, const cJSON *path, posed_frame *frame)
{
    double matrix[16];
    const double fov = number_of(item, "fov");
    read_sides(path, "render_width", "render_height", &frame->intrinsics);
    if (!(fov > 0 && fov < 180)) {
        return "fov: no angle between 0 and 180 degrees";
    }
    frame->intrinsics.angle_y = fov * M_PI / 180;
    if (!read_row(cJSON_GetObjectItemCaseSensitive(item, "camera_to_world"), 16, matrix)) {
        return "camera_to_world: not 16 numbers";
    }
    return pose_of_matrix(matrix, T3R_AXES_OPENGL, &frame->pose);
}

/* Refuses cameras that no pinhole is. Returns NULL, or what is wrong. */
static const char *check_path(const cJSON *path)
{
    const cJSON *type = cJSON_GetObjectItemCaseSensitive(path, "camera_type");
    if (type != NULL && !(cJSON_IsString(type) && strcmp(type->valuestring, "perspective") == 0)) {
        return "camera_type: pictures are drawn by pinhole cameras, perspective";
    }
    return cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(path, PATH)) ? NULL : PATH ": not an array";
}

/* ---- 3D Gaussian Splatting ------------------------------------------------------------------------------------- */

/* Reads an entry of cameras.json: position, and rotation from camera to world with the axes of OpenCV. Returns NULL, or
 * what is wrong. */
static const char *read_camera(const cJSON *item, posed_frame *frame)
{
    const cJSON *rows = cJSON_GetObjectItemCaseSensitive(item, "rotation");
    double matrix[16] = {[15] = 1}, position[3];
    read_sides(item, "width", "height", &frame->intrinsics);
    frame->intrinsics.fx = number_of(item, "fx");
    frame->intrinsics.fy = number_of(item, "fy");
    if (isnan(frame->intrinsics.fx) || isnan(frame->intrinsics.fy)) {
        return "fx, fy: missing";
    }
    if (!read_row(cJSON_GetObjectItemCaseSensitive(item, "position"), 3, position)) {
        return "position: not 3 numbers";
    }
    for (int y = 0; y < 3; y++) {
        if (!read_row(cJSON_GetArrayItem(rows, y), 3, matrix + 4 * y)) {
            return "rotation: not 3 rows of 3 numbers";
        }
        matrix[4 * y + 3] = position[y];
    }
    return pose_of_matrix(matrix, T3R_AXES_OPENCV, &frame->pose);
}

int camera_list_read(const cJSON *root, posed_folder *out, double *rate, char *error, size_t error_bytes)
{
    const bool is_path = !cJSON_IsArray(root);
    const char *wrong = is_path ? check_path(root) : NULL;
    const cJSON *list = is_path ? cJSON_GetObjectItemCaseSensitive(root, PATH) : root, *item;
    const double fps = is_path ? number_of(root, "fps") : NAN;
    const int count = wrong == NULL ? cJSON_GetArraySize(list) : 0;
    memset(out, 0, sizeof *out);
    *rate = fps > 0 ? fps : 0;
    if (wrong == NULL && (count == 0 || count > T3R_LIMIT_FRAMES)) {
        wrong = count == 0 ? "holds no camera" : T3R_LIMIT_TEXT("more than ", T3R_LIMIT_FRAMES, " cameras");
    }
    out->frames = wrong == NULL ? calloc((size_t)count, sizeof *out->frames) : NULL;
    if (out->frames == NULL) {
        return t3r_reason(error, error_bytes, "%s", wrong != NULL ? wrong : "out of memory");
    }
    cJSON_ArrayForEach(item, list)
    {
        posed_frame *frame = &out->frames[out->frame_count++];
        frame->intrinsics = posed_intrinsics_unknown();
        frame->posed = true;
        wrong = !cJSON_IsObject(item) ? "not an object"
                : is_path             ? read_step(item, root, frame)
                                      : read_camera(item, frame);
        if (wrong != NULL) {
            rejected_mark(frame, "%s", wrong);
        }
    }
    return 0;
}
