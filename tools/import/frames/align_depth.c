/* SPDX-License-Identifier: Apache-2.0 */
#include "import/frames/align_depth.h"

#include <math.h>
#include <stdlib.h>

#include "core/little_endian.h"
#include "host/reason.h"
#include "import/depth/register_depth.h"
#include "messages/fixed_camera.h"

#define SAME_PIXELS 0.5

bool align_depth_same(const posed_intrinsics *colour, const posed_intrinsics *depth, double width, double height,
                      double depth_width, double depth_height)
{
    const double x[2] = {depth->cx / depth->fx, (depth_width - depth->cx) / depth->fx};
    const double y[2] = {depth->cy / depth->fy, (depth_height - depth->cy) / depth->fy};
    bool same = colour->distortion == T3R_DISTORTION_NONE && depth->distortion == T3R_DISTORTION_NONE;
    for (int i = 0; i < 2; i++) {
        const double edge_x = i == 0 ? colour->cx : width - colour->cx;
        const double edge_y = i == 0 ? colour->cy : height - colour->cy;
        same =
            same && fabs(x[i] * colour->fx - edge_x) <= SAME_PIXELS && fabs(y[i] * colour->fy - edge_y) <= SAME_PIXELS;
    }
    return same;
}

static int lens_of(const t3r_recorded_camera *camera, lens *out, char *error, size_t error_bytes)
{
    t3r_camera fixed;
    const char *wrong = t3r_fixed_camera(camera, &fixed);
    if (wrong != NULL) {
        return t3r_reason(error, error_bytes, "%s", wrong);
    }
    lens_of_camera(&fixed, camera->width, camera->height, out);
    return 0;
}

int align_depth(const posed_frame *frame, const t3r_recorded_camera *colour, picture *depth, char *error,
                size_t error_bytes)
{
    lens from, to;
    ray_grid rays = {0};
    const posed_frame beside = {.intrinsics = frame->depth_lens, .pose = rigid_identity};
    t3r_recorded_camera camera = {0};
    if (posed_frame_camera(&beside, depth->width, depth->height, &camera, error, error_bytes) != 0 ||
        lens_of(&camera, &from, error, error_bytes) != 0 || lens_of(colour, &to, error, error_bytes) != 0) {
        return -1;
    }
    const size_t count = (size_t)depth->width * depth->height;
    uint8_t *measured = malloc(count * 2);
    t3r_frame seen = {.width = colour->width,
                      .height = colour->height,
                      .depth = measured,
                      .depth_width = depth->width,
                      .depth_height = depth->height,
                      .depth_stride_bytes = depth->width * 2,
                      .depth_unit_q40 = UINT64_C(1) << 40}; /* as in from_depth */
    picture drawn = {.channels = 1, .bits = 16};
    register_depth_size(&seen, &drawn.width, &drawn.height);
    const size_t drawn_count = (size_t)drawn.width * drawn.height;
    drawn.samples = malloc(drawn_count * 2);
    int status =
        measured != NULL && drawn.samples != NULL && ray_grid_make(&rays, &from, depth->width, depth->height, frame)
            ? 0
            : t3r_reason(error, error_bytes, "out of memory");
    if (status == 0) {
        uint16_t *samples = depth->samples;
        for (size_t i = 0; i < count; i++) {
            t3r_store_le16(measured + 2 * i, samples[i]);
        }
        register_depth(&seen, &rays, &to, &frame->from_depth, drawn.samples);
        samples = drawn.samples;
        for (size_t i = 0; i < drawn_count; i++) {
            samples[i] = t3r_load_le16((const uint8_t *)&samples[i]);
        }
        picture_free(depth);
        *depth = drawn;
        drawn.samples = NULL;
    }
    ray_grid_free(&rays);
    free(drawn.samples);
    free(measured);
    return status;
}
