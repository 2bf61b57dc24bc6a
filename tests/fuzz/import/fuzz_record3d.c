/* SPDX-License-Identifier: Apache-2.0 */
/* The metadata of a Record3D export: an error, or poses within the limits and lenses of finite numbers, except in
 * frames that are rejected. */
#include <math.h>
#include <stdlib.h>

#include "import/folders/record3d.h"
#include "mcap/reader_limits.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    posed_folder folder;
    uint32_t sides[2] = {0, 0};
    char error[256] = "";
    int status = record3d_parse((const char *)data, size, &folder, sides, error, sizeof error);
    if ((status != 0) != (error[0] != '\0') || sides[0] > T3R_MAX_SIDE || sides[1] > T3R_MAX_SIDE) {
        abort();
    }
    for (uint32_t i = 0; status == 0 && i < folder.frame_count; i++) {
        const posed_frame *frame = &folder.frames[i];
        double norm = 0;
        if (frame->rejected) {
            continue;
        }
        for (int k = 0; k < 4; k++) {
            norm += frame->pose.rotation[k] * frame->pose.rotation[k];
        }
        if (!(fabs(norm - 1) < 1e-9) || !(fabs(frame->pose.position[2]) < 1 << T3R_LIMIT_POSITION_LOG2) ||
            !isfinite(frame->intrinsics.fx + frame->intrinsics.cy)) {
            abort();
        }
    }
    posed_folder_close(&folder);
    return 0;
}
