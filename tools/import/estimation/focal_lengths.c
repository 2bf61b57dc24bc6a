/* SPDX-License-Identifier: Apache-2.0 */
#include "import/estimation/focal_lengths.h"

#include <math.h>

#include "host/reason.h"
#include "import/frames/frame.h"
#include "pictures/exif.h"

bool focal_length_is_unknown(const posed_frame *frame)
{
    const posed_intrinsics *in = &frame->intrinsics;
    return isnan(in->fx) && isnan(in->fy) && isnan(in->angle_x) && isnan(in->angle_y);
}

void focal_lengths_set(const char *directory, posed_folder *folder, double share)
{
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        posed_frame *frame = &folder->frames[i];
        char reason[256];
        uint32_t width, height;
        double focal_35mm;
        if (focal_length_is_unknown(frame) &&
            import_picture_facts(directory, frame, &width, &height, &focal_35mm, reason, sizeof reason) == 0) {
            frame->intrinsics.fx = share * fmax(width, height);
        }
    }
}

void focal_lengths_from_exif(const char *directory, posed_folder *folder)
{
    uint32_t unknown = 0, stated = 0;
    double share = 0, first_35mm = 0;
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        posed_frame *frame = &folder->frames[i];
        char reason[256];
        uint32_t width, height;
        double focal_35mm;
        const bool is_unknown = focal_length_is_unknown(frame);
        unknown += is_unknown;
        if (is_unknown &&
            import_picture_facts(directory, frame, &width, &height, &focal_35mm, reason, sizeof reason) == 0 &&
            focal_35mm != 0) {
            frame->intrinsics.fx = exif_focal_pixels(focal_35mm, width, height);
            share = stated == 0 ? frame->intrinsics.fx / fmax(width, height) : share;
            first_35mm = stated++ == 0 ? focal_35mm : first_35mm;
        }
    }
    if (stated > 0) {
        focal_lengths_set(directory, folder, share);
        (void)t3r_reason(folder->focal, sizeof folder->focal,
                         "by EXIF of %u of %u pictures, the first %.4g mm in terms of 35 mm film", stated, unknown,
                         first_35mm);
    }
}
