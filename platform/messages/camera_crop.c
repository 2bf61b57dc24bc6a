/* SPDX-License-Identifier: Apache-2.0 */
#include "camera_crop.h"

#include "fixed_camera.h"
#include "host/program_check.h"
#include "host/reason.h"

void t3r_crop_camera(t3r_recorded_camera *camera, const t3r_crop *crop, uint32_t width, uint32_t height)
{
    double scale_x = (double)width / crop->width;
    double scale_y = (double)height / crop->height;
    camera->fx *= scale_x;
    camera->fy *= scale_y;
    /* scaling keeps the corner of the top-left pixel, which is half a pixel before its centre */
    camera->cx = (camera->cx + 0.5 - crop->x) * scale_x - 0.5;
    camera->cy = (camera->cy + 0.5 - crop->y) * scale_y - 0.5;
    camera->width = width;
    camera->height = height;
}

/* Whether `length` pixels from `start` on lie within `most`, and are any. */
static bool is_within(uint32_t start, uint32_t length, uint32_t most)
{
    return length > 0 && length <= most && start <= most - length;
}

t3r_status t3r_camera_crop_as(t3r_program program, t3r_recorded_camera *camera, const t3r_crop *crop, uint32_t width,
                              uint32_t height, char *error, size_t error_bytes)
{
    if (!t3r_program_fits(program, t3r_host_program(), error, error_bytes)) {
        return T3R_ERR_INTERFACE;
    }
    if (!is_within(crop->x, crop->width, camera->width) || !is_within(crop->y, crop->height, camera->height)) {
        t3r_reason(error, error_bytes, "the crop of %ux%u pixels at %u, %u is not inside the picture of %ux%u",
                   crop->width, crop->height, crop->x, crop->y, camera->width, camera->height);
        return T3R_ERR_CAMERA;
    }
    if (width == 0 || height == 0) {
        t3r_reason(error, error_bytes, "the size is %ux%u pixels", width, height);
        return T3R_ERR_CAMERA;
    }
    t3r_crop_camera(camera, crop, width, height);
    t3r_reason(error, error_bytes, "%s", "");
    return T3R_OK;
}

t3r_status t3r_camera_fixed_as(t3r_program program, const t3r_recorded_camera *camera, t3r_camera *out, char *error,
                               size_t error_bytes)
{
    if (!t3r_program_fits(program, t3r_host_program(), error, error_bytes)) {
        return T3R_ERR_INTERFACE;
    }
    const char *wrong = t3r_fixed_camera(camera, out);
    t3r_reason(error, error_bytes, "%s", wrong != NULL ? wrong : "");
    return wrong != NULL ? T3R_ERR_CAMERA : T3R_OK;
}
