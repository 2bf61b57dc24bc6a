/* SPDX-License-Identifier: Apache-2.0 */
#include "import/frames/posed_frame.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "host/reason.h"
#include "trim3r.h"

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

bool posed_exists(const char *directory, const char *name)
{
    char *path = posed_path(directory, name);
    bool found = path != NULL && access(path, F_OK) == 0;
    free(path);
    return found;
}

posed_intrinsics posed_intrinsics_of(const double numbers[INTRINSICS_NUMBERS])
{
    posed_intrinsics out = {.width = NAN,
                            .height = NAN,
                            .angle_x = NAN,
                            .angle_y = NAN,
                            .fx = numbers[0],
                            .fy = numbers[1],
                            .cx = numbers[2] + 0.5,
                            .cy = numbers[3] + 0.5};
    for (uint32_t i = 0; i < INTRINSICS_NUMBERS - 4; i++) {
        out.coefficients[i] = numbers[4 + i];
        out.distortion = numbers[4 + i] != 0 ? T3R_DISTORTION_RADTAN : out.distortion;
    }
    return out;
}

posed_intrinsics posed_intrinsics_pinhole(double fx, double fy, double cx, double cy)
{
    return posed_intrinsics_of((const double[INTRINSICS_NUMBERS]){fx, fy, cx, cy});
}

posed_intrinsics posed_intrinsics_unknown(void)
{
    return posed_intrinsics_pinhole(NAN, NAN, NAN, NAN);
}

#define ASPECT_TOLERANCE 0.04

bool posed_same_aspect(double width, double height, double other_width, double other_height)
{
    return fabs(width * other_height / (height * other_width) - 1) <= ASPECT_TOLERANCE;
}

/* Checks that the camera is that of a picture of this size. Where nothing says the size that it is for, its principal
 * point must lie in the picture. */
static int check_size(const posed_intrinsics *in, const t3r_recorded_camera *camera, char *error, size_t error_bytes)
{
    const uint32_t width = camera->width, height = camera->height;
    const bool grid = in->grid_width > 0 && in->grid_height > 0;
    if (grid && !posed_same_aspect(in->grid_width, in->grid_height, width, height)) {
        return t3r_reason(
            error, error_bytes,
            "w, h: the intrinsics are for %gx%g pixels, but the picture has %ux%u: another aspect; turn or "
            "crop the pictures to that view",
            in->grid_width, in->grid_height, width, height);
    }
    const bool known = grid || (!isnan(in->width) && !isnan(in->height));
    const double x = camera->cx + 0.5, y = camera->cy + 0.5;
    if (!known && !(x >= 0 && x <= width && y >= 0 && y <= height)) {
        return t3r_reason(error, error_bytes,
                          "cx, cy: %g, %g lies outside the picture of %ux%u pixels: intrinsics for another size? Scale "
                          "them to the picture; if it is a part of a larger one, say so by w and h in transforms.json",
                          camera->cx, camera->cy, width, height);
    }
    return 0;
}

/* Returns a focal length: the given one, else from a field of view over `pixels`, else the other axis's. */
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
    if (check_size(in, camera, error, error_bytes) != 0) {
        return -1;
    }
    memcpy(camera->coefficients, in->coefficients, sizeof camera->coefficients);
    memcpy(camera->position, frame->pose.position, sizeof camera->position);
    memcpy(camera->rotation, frame->pose.rotation, sizeof camera->rotation);
    return 0;
}

void posed_frame_free(posed_frame *frame)
{
    free(frame->image);
    free(frame->depth);
    free(frame->mask);
    free(frame->wrong);
    free(frame->pointmap);
    free(frame->confidence);
    *frame = (posed_frame){0};
}

void posed_folder_close(posed_folder *folder)
{
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        posed_frame_free(&folder->frames[i]);
    }
    free(folder->frames);
    free(folder->triplets);
    left_out_free(&folder->left_out);
    text_list_free(&folder->remarks);
    memset(folder, 0, sizeof *folder);
}
