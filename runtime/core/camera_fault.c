/* SPDX-License-Identifier: Apache-2.0 */
#include "camera_checks.h"

t3r_status t3r_camera_fault(const t3r_camera *camera, uint32_t width, uint32_t height, t3r_fault *fault)
{
    return t3r_camera_checks(camera, width, height, fault);
}
