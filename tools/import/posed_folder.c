#include "import/posed_folder.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "file_bytes.h"
#include "reason.h"
#include "trim3r.h"

#define MAX_TEXT_BYTES ((size_t)256 << 20)

char *posed_path(const char *directory, const char *name)
{
    if (name[0] == '/') {
        return strdup(name);
    }
    while (strncmp(name, "./", 2) == 0) {
        name += 2;
    }
    size_t length = strlen(directory);
    bool slash = length > 0 && directory[length - 1] != '/';
    size_t bytes = length + slash + strlen(name) + 1;
    char *path = malloc(bytes);
    if (path != NULL) {
        snprintf(path, bytes, "%s%s%s", directory, slash ? "/" : "", name);
    }
    return path;
}

/* The nearest rotation: Newton's iteration for the polar factor, R <- R (3 I - R^T R) / 2. Quadratic: an error of
 * 1e-3 is below 1e-12 after two steps. */
static void orthonormalise(double r[9])
{
    for (int step = 0; step < 3; step++) {
        double next[9];
        for (int row = 0; row < 3; row++) {
            for (int column = 0; column < 3; column++) {
                double sum = 0;
                for (int k = 0; k < 3; k++) {
                    double gram = r[k] * r[column] + r[3 + k] * r[3 + column] + r[6 + k] * r[6 + column];
                    sum += r[row * 3 + k] * ((k == column ? 3.0 : 0.0) - gram);
                }
                next[row * 3 + column] = sum / 2;
            }
        }
        memcpy(r, next, sizeof next);
    }
}

/* Shepperd's method: divides by the largest of the four components, which is at least 1/2. */
static void to_quaternion(const double r[9], double q[4])
{
    double trace = r[0] + r[4] + r[8];
    double squares[4] = {trace, r[0], r[4], r[8]};
    int largest = 0;
    for (int i = 1; i < 4; i++) {
        if (squares[i] > squares[largest]) {
            largest = i;
        }
    }
    if (largest == 0) {
        q[0] = 1 + trace;
        q[1] = r[7] - r[5];
        q[2] = r[2] - r[6];
        q[3] = r[3] - r[1];
    } else {
        int i = largest - 1, j = (i + 1) % 3, k = (i + 2) % 3;
        q[0] = r[k * 3 + j] - r[j * 3 + k];
        q[1 + i] = 1 + r[i * 3 + i] - r[j * 3 + j] - r[k * 3 + k];
        q[1 + j] = r[i * 3 + j] + r[j * 3 + i];
        q[1 + k] = r[i * 3 + k] + r[k * 3 + i];
    }
    double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    double sign = q[0] < 0 ? -1 : 1;
    for (int i = 0; i < 4; i++) {
        q[i] *= sign / norm;
    }
}

const char *posed_quaternion(const double matrix[9], double quaternion[4])
{
    for (int i = 0; i < 9; i++) {
        if (!isfinite(matrix[i])) {
            return "an entry is not finite";
        }
    }
    for (int a = 0; a < 3; a++) {
        for (int b = a; b < 3; b++) {
            double dot = matrix[a] * matrix[b] + matrix[3 + a] * matrix[3 + b] + matrix[6 + a] * matrix[6 + b];
            if (!(fabs(dot - (a == b ? 1.0 : 0.0)) <= 1e-3)) {
                return "the rotation is not orthonormal within 1e-3";
            }
        }
    }
    double determinant = matrix[0] * (matrix[4] * matrix[8] - matrix[5] * matrix[7]) -
                         matrix[1] * (matrix[3] * matrix[8] - matrix[5] * matrix[6]) +
                         matrix[2] * (matrix[3] * matrix[7] - matrix[4] * matrix[6]);
    if (determinant < 0) {
        return "the rotation mirrors (its determinant is -1)";
    }
    double r[9];
    memcpy(r, matrix, sizeof r);
    orthonormalise(r);
    to_quaternion(r, quaternion);
    return NULL;
}

void posed_matrix(const double q[4], double m[9])
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        const double *v = q + 1;
        m[3 * i + i] = 1 - 2 * (v[j] * v[j] + v[k] * v[k]);
        m[3 * i + j] = 2 * (v[i] * v[j] - q[0] * v[k]);
        m[3 * i + k] = 2 * (v[i] * v[k] + q[0] * v[j]);
    }
}

posed_intrinsics posed_intrinsics_of(const double numbers[9])
{
    posed_intrinsics out = {.width = NAN,
                            .height = NAN,
                            .angle_x = NAN,
                            .angle_y = NAN,
                            .fx = numbers[0],
                            .fy = numbers[1],
                            .cx = numbers[2] + 0.5,
                            .cy = numbers[3] + 0.5};
    for (int i = 0; i < 5; i++) {
        out.coefficients[i] = numbers[4 + i];
        out.distortion = numbers[4 + i] != 0 ? T3R_DISTORTION_RADTAN : out.distortion;
    }
    return out;
}

/* A focal length: the given one, else from a field of view over `pixels`, else the other axis's. */
static double focal_length(double given, double angle, double pixels, double other)
{
    if (!isnan(given)) {
        return given;
    }
    return isnan(angle) ? other : pixels / (2 * tan(angle / 2));
}

int posed_frame_camera(const posed_frame *frame, uint32_t width, uint32_t height, t3r_recorded_camera *camera,
                       char *error, size_t error_bytes)
{
    const posed_intrinsics *in = &frame->intrinsics;
    if (!isnan(in->width) && in->width != width) {
        return t3r_reason(error, error_bytes, "w: %.17g, but the picture is %u pixels wide", in->width, width);
    }
    if (!isnan(in->height) && in->height != height) {
        return t3r_reason(error, error_bytes, "h: %.17g, but the picture is %u pixels high", in->height, height);
    }
    *camera = (t3r_recorded_camera){.width = width, .height = height, .distortion = in->distortion};
    double across = in->grid_width > 0 ? width / in->grid_width : 1;
    double down = in->grid_height > 0 ? height / in->grid_height : 1;
    double fx = focal_length(in->fx, in->angle_x, width, NAN);
    double fy = focal_length(in->fy, in->angle_y, height, fx);
    camera->fx = isnan(fx) ? fy : fx;
    camera->fy = fy;
    if (isnan(camera->fx)) {
        return t3r_reason(error, error_bytes, "fl_x: missing, and no camera_angle_x to derive it from");
    }
    camera->fx *= across;
    camera->fy *= down;
    camera->cx = (isnan(in->cx) ? width / 2.0 : in->cx * across) - 0.5;
    camera->cy = (isnan(in->cy) ? height / 2.0 : in->cy * down) - 0.5;
    if (!(camera->fx > 0 && isfinite(camera->fx)) || !(camera->fy > 0 && isfinite(camera->fy))) {
        return t3r_reason(error, error_bytes, "fl_x, fl_y: %g, %g: focal lengths must be positive", camera->fx,
                          camera->fy);
    }
    memcpy(camera->coefficients, in->coefficients, sizeof camera->coefficients);
    memcpy(camera->position, frame->position, sizeof camera->position);
    memcpy(camera->rotation, frame->rotation, sizeof camera->rotation);
    return 0;
}

static bool exists(const char *directory, const char *name)
{
    char *path = posed_path(directory, name);
    bool found = path != NULL && access(path, F_OK) == 0;
    free(path);
    return found;
}

static int read_transforms(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                           size_t error_bytes)
{
    char *path = posed_path(directory, "transforms.json");
    if (path == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    size_t bytes = 0;
    char reason[512];
    char *text = (char *)t3r_file_bytes(path, MAX_TEXT_BYTES, &bytes, error, error_bytes);
    int status = -1;
    if (text != NULL) {
        status = transforms_json_parse(text, bytes, options, out, reason, sizeof reason);
        if (status != 0) {
            t3r_reason(error, error_bytes, "%s: %s", path, reason);
        }
    }
    free(text);
    free(path);
    return status;
}

int posed_folder_open(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                      size_t error_bytes)
{
    memset(out, 0, sizeof *out);
    if (!exists(directory, ".")) {
        return t3r_reason(error, error_bytes, "%s: %s", directory, errno == ENOTDIR ? "not a folder" : strerror(errno));
    }
    if (exists(directory, "transforms.json")) {
        if (options != NULL && options->intrinsics_count != 0) {
            return t3r_reason(error, error_bytes,
                              "%s/transforms.json: has its own intrinsics; --intrinsics is for folders without",
                              directory);
        }
        return read_transforms(directory, options, out, error, error_bytes);
    }
    if (exists(directory, "rgb.txt") || exists(directory, "groundtruth.txt")) {
        return tum_rgbd_read(directory, options, out, error, error_bytes);
    }
    if (options != NULL && options->without_poses) {
        return picture_folder_read(directory, options, out, error, error_bytes);
    }
    return t3r_reason(error, error_bytes,
                      "%s: neither transforms.json nor rgb.txt and groundtruth.txt (TUM RGB-D) is there", directory);
}

void posed_folder_close(posed_folder *folder)
{
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        free(folder->frames[i].image);
        free(folder->frames[i].depth);
        free(folder->frames[i].pointmap);
        free(folder->frames[i].confidence);
    }
    free(folder->frames);
    free(folder->triplets);
    memset(folder, 0, sizeof *folder);
}
