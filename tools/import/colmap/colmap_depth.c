/* SPDX-License-Identifier: Apache-2.0 */
#include "import/colmap/colmap_depth.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PLACE "stereo/depth_maps"
enum { PATH_BYTES = 8192, MAPS_LOOKED_AT = 8, STEPS_OF_MEDIAN = 8192 };

static const char *const endings[] = {".geometric.bin", ".photometric.bin"};
static const char *const below[] = {"dense", "dense/0"};

int colmap_depth_find(const char *directory, const char *image, posed_frame *frame)
{
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        char path[PATH_BYTES];
        const int length = snprintf(path, sizeof path, PLACE "/%s%s", image, endings[i]);
        if (length > 0 && length < PATH_BYTES && posed_exists(directory, path)) {
            frame->depth = strdup(path);
            frame->depth_raw = (raw_depth){.kind = RAW_DEPTH_COLMAP};
            return frame->depth != NULL ? 0 : -1;
        }
    }
    return 0;
}

static double median_of(const char *directory, const posed_frame *frame)
{
    char *path = posed_path(directory, frame->depth);
    const double median = path == NULL ? 0 : raw_depth_median(path, &frame->depth_raw);
    free(path);
    return median;
}

void colmap_depth_set_unit(const char *directory, posed_folder *folder)
{
    const uint32_t every = folder->frame_count / MAPS_LOOKED_AT + 1;
    double largest = 0;
    for (uint32_t i = 0; i < folder->frame_count && !folder->depth_unit_given; i += every) {
        if (folder->frames[i].depth_raw.kind == RAW_DEPTH_COLMAP) {
            largest = fmax(largest, median_of(directory, &folder->frames[i]));
        }
    }
    if (largest > 0) {
        folder->depth_unit = largest / STEPS_OF_MEDIAN;
        folder->depth_unit_given = true;
    }
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        folder->frames[i].depth_raw.unit = folder->depth_unit;
    }
}

int colmap_depth_tell(const char *directory, posed_folder *folder)
{
    for (size_t i = 0; i < sizeof below / sizeof *below; i++) {
        char path[64];
        snprintf(path, sizeof path, "%s/" PLACE, below[i]);
        if (posed_exists(directory, path)) {
            return text_list_add(&folder->remarks,
                                 "%s holds depth maps of undistorted pictures; import %s/%s reads them", below[i],
                                 directory, below[i]);
        }
    }
    return 0;
}
