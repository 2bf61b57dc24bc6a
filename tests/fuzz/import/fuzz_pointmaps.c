/* SPDX-License-Identifier: Apache-2.0 */
/* Any .npz or .npy: an error, or maps whose views are finite, in any order, or give a reason why not. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/pointmaps/pointmaps.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check_cameras(const pointmaps *maps)
{
    for (uint32_t v = 0; v < maps->count; v++) {
        if (maps->intrinsics != NULL && !(maps->intrinsics[v][0] > 0)) {
            abort();
        }
        for (int i = 0; maps->poses != NULL && i < 4; i++) {
            if (!isfinite(maps->poses[v].rotation[i])) {
                abort();
            }
        }
    }
}

static void check_view(pointmaps *maps, uint32_t index, float *depth)
{
    size_t pixels = (size_t)maps->width * maps->height;
    char error[256] = "";
    int status = pointmaps_read(maps, index, error, sizeof error);
    if ((status != 0) != (error[0] != '\0')) {
        abort();
    }
    if (status != 0) {
        return;
    }
    pointmaps_depth(maps, maps->poses != NULL ? &maps->poses[index] : &rigid_identity, 1, depth);
    for (size_t i = 0; i < 3 * pixels; i++) {
        if (!isfinite(maps->points[i])) {
            abort();
        }
    }
    if (maps->has_confidence && !isfinite(maps->confidence[pixels - 1])) {
        abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { MOST_PIXELS = 1 << 20 }; /* so that a time limit finds slowness, not size */
    pointmaps maps;
    char error[256] = "";
    int status = pointmaps_parse(data, size, &maps, error, sizeof error);
    if ((status != 0) != (error[0] != '\0')) {
        abort();
    }
    float *depth = status == 0 && (size_t)maps.width * maps.height <= MOST_PIXELS
                       ? malloc((size_t)maps.width * maps.height * sizeof *depth)
                       : NULL;
    if (depth != NULL) {
        check_cameras(&maps);
        check_view(&maps, maps.count - 1, depth);
        check_view(&maps, 0, depth);
        pointmaps_forget(&maps);
        check_view(&maps, maps.count / 2, depth);
    }
    free(depth);
    pointmaps_free(&maps);
    return 0;
}
