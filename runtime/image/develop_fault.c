/* SPDX-License-Identifier: Apache-2.0 */
#include "develop.h"
#include "develop_checks.h"

t3r_status t3r_frame_fault(const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, t3r_camera *resized,
                           t3r_fault *fault)
{
    return t3r_develop_checks(rt, frame, camera, resized, fault);
}
