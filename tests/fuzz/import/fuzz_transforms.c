/* SPDX-License-Identifier: Apache-2.0 */
/* Any text as a transforms.json: an error or cameras that the recorder accepts; no file is touched. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/folders/transforms_json.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void parse(const uint8_t *data, size_t size, const posed_folder_options *options)
{
    posed_folder folder;
    char error[256] = "";
    int status = transforms_json_parse((const char *)data, size, options, &folder, error, sizeof error);
    if ((status != 0) != (error[0] != '\0')) {
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
        t3r_recorded_camera camera;
        uint32_t width = isnan(frame->intrinsics.width) ? 64 : (uint32_t)frame->intrinsics.width;
        uint32_t height = isnan(frame->intrinsics.height) ? 48 : (uint32_t)frame->intrinsics.height;
        if (!(fabs(norm - 1) < 1e-9) || frame->image == NULL) {
            abort();
        }
        if (posed_frame_camera(frame, width, height, &camera, error, sizeof error) == 0 &&
            !(camera.fx > 0 && camera.fy > 0 && isfinite(camera.cx) && isfinite(camera.cy))) {
            abort();
        }
    }
    posed_folder_close(&folder);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const posed_folder_options without = {.without_poses = true, .without_intrinsics = true};
    parse(data, size, NULL);
    parse(data, size, &without);
    return 0;
}
