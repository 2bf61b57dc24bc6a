/* SPDX-License-Identifier: Apache-2.0 */
#include "posing/opencv_module.h"

#include "host/module.h"
#include "host/reason.h"

const pose_module *pose_module_load(char *error, size_t error_bytes)
{
    char why[256];
    const pose_module *module = t3r_module_table("posing", why, sizeof why);
    if (module == NULL) {
        t3r_reason(error, error_bytes,
                   "poses are estimated by OpenCV, and %s; install the package trim3r-poses, or build with OpenCV: "
                   "`tools/setup --poses` (Debian: libopencv-calib3d-dev), then configure again",
                   why);
    }
    return module;
}
