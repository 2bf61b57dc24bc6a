/* A .npz or .npy, whatever it is: an error, or maps that are finite and depths that are steps. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/npy.h"
#include "import/pointmaps.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check(const pointmaps *maps)
{
    size_t pixels = (size_t)maps->width * maps->height;
    float *depth = malloc(pixels * sizeof *depth);
    for (uint32_t v = 0; v < maps->count && depth != NULL; v++) {
        pointmaps_depth(maps, v, maps->poses != NULL ? &maps->poses[v] : &motion_none, 1, depth);
        for (size_t i = 0; i < 3 * pixels; i++) {
            if (!isfinite(maps->points[3 * pixels * v + i])) {
                abort();
            }
        }
        if (maps->confidence != NULL && !isfinite(maps->confidence[pixels * v])) {
            abort();
        }
        if (maps->intrinsics != NULL && !(maps->intrinsics[v][0] > 0)) {
            abort();
        }
    }
    free(depth);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    pointmaps maps;
    npy_array array;
    char error[256] = "";
    int status = pointmaps_parse(data, size, &maps, error, sizeof error);
    if ((status != 0) != (error[0] != '\0')) {
        abort();
    }
    if (status == 0) {
        check(&maps);
    }
    pointmaps_free(&maps);
    error[0] = '\0';
    status = npy_parse(data, size, &array, error, sizeof error);
    if ((status != 0) != (error[0] != '\0')) {
        abort();
    }
    for (size_t i = 0; status == 0 && i < array.count; i++) {
        (void)npy_value(&array, i);
    }
    return 0;
}
