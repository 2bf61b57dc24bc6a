/* SPDX-License-Identifier: Apache-2.0 */
/* A COLMAP model, text or binary by the first byte, with a marker between cameras and images. Gives an error, or
 * poses within the limits and lenses of finite numbers. */
#define _GNU_SOURCE /* memmem() */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "import/colmap/colmap_model.h"
#include "mcap/reader_limits.h"

#define MARKER "\n=\n"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef int (*reader)(FILE *file, colmap_model *model, char *error, size_t error_bytes);

static int read_part(reader read, const uint8_t *data, size_t size, colmap_model *model)
{
    char error[256] = "";
    FILE *file =
        size > 0 ? fmemopen((void *)(uintptr_t)data, size, "rb") : tmpfile(); /* fmemopen() refuses a size of 0 */
    if (file == NULL) {
        abort();
    }
    int status = read(file, model, error, sizeof error);
    fclose(file);
    if ((status != 0) != (error[0] != '\0')) {
        abort();
    }
    return status;
}

static void check(const colmap_model *model)
{
    for (uint32_t i = 0; i < model->image_count; i++) {
        const colmap_image *image = &model->images[i];
        double norm = 0;
        for (int k = 0; k < 4; k++) {
            norm += image->pose.rotation[k] * image->pose.rotation[k];
        }
        if (image->wrong != NULL) {
            continue;
        }
        bool inside = image->name[0] != '\0' && fabs(norm - 1) < 1e-9;
        for (int k = 0; k < 3; k++) {
            inside = inside && fabs(image->pose.position[k]) < 1 << T3R_LIMIT_POSITION_LOG2;
        }
        const colmap_camera *camera = colmap_model_camera(model, image->camera);
        if (!inside || (camera != NULL && camera->wrong == NULL && !isfinite(camera->intrinsics.cx))) {
            abort();
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size == 0) {
        return 0;
    }
    bool text = data[0] % 2 != 0;
    const uint8_t *rest = data + 1, *end = data + size;
    const uint8_t *marker = memmem(rest, (size_t)(end - rest), MARKER, strlen(MARKER));
    const uint8_t *images = marker != NULL ? marker + strlen(MARKER) : end;
    colmap_model model = {0};
    if (read_part(text ? colmap_read_cameras_text : colmap_read_cameras_binary, rest,
                  (size_t)((marker != NULL ? marker : end) - rest), &model) == 0 &&
        read_part(text ? colmap_read_images_text : colmap_read_images_binary, images, (size_t)(end - images), &model) ==
            0 &&
        colmap_model_sort(&model) == NULL) {
        check(&model);
    }
    colmap_model_free(&model);
    return 0;
}
