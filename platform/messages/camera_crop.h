/* SPDX-License-Identifier: Apache-2.0 */
/* Intrinsics of cropped and resized pictures. */
#ifndef T3R_PLATFORM_CAMERA_CROP_H
#define T3R_PLATFORM_CAMERA_CROP_H

#include "trim3r_host.h"

/* Adapts a camera to a crop, which is not empty, resized to width x height. */
void t3r_crop_camera(t3r_recorded_camera *camera, const t3r_crop *crop, uint32_t width, uint32_t height);

#endif
