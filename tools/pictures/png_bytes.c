/* SPDX-License-Identifier: Apache-2.0 */
#include "pictures/png_bytes.h"

#include <stdlib.h>

#include <png.h>

uint8_t *png_bytes(uint32_t width, uint32_t height, uint32_t channels, const uint8_t *samples, size_t *count)
{
    png_image image = {.version = PNG_IMAGE_VERSION,
                       .width = width,
                       .height = height,
                       .format = channels == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_GRAY};
    png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(image);
    uint8_t *file = malloc(bytes);
    if (file != NULL && !png_image_write_to_memory(&image, file, &bytes, 0, samples, 0, NULL)) {
        free(file);
        file = NULL;
    }
    png_image_free(&image);
    *count = bytes;
    return file;
}
