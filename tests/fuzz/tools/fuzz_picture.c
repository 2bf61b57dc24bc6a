/* SPDX-License-Identifier: Apache-2.0 */
/* Any bytes as a PNG or JPEG: an error, or a picture of the size that its header gave. */
#define _GNU_SOURCE /* memfd_create() */
#include <string.h>

#include "fuzz/memory_file.h"
#include "pictures/picture.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { MOST_PIXELS = 1 << 20 }; /* so that a time limit finds slowness, not size */
    char path[MEMORY_FILE_PATH_BYTES], error[256] = "";
    int descriptor = memory_file(data, size, path);
    uint32_t width, height;
    picture p;
    int status = picture_size(path, &width, &height, error, sizeof error);
    if ((status != 0) != (error[0] != '\0') ||
        (status == 0 && (width > PICTURE_LARGEST_SIDE || height > PICTURE_LARGEST_SIDE))) {
        abort();
    }
    if (status == 0 && width * height <= MOST_PIXELS) {
        status = picture_read_large(path, &p, error, sizeof error);
        if ((status != 0) != (error[0] != '\0') ||
            (status == 0 && (p.width != width || p.height != height || p.orientation < 1 || p.orientation > 8))) {
            abort();
        }
        if (status == 0) {
            size_t bytes = (size_t)p.width * p.height * p.channels * (p.bits / 8);
            void *copy = malloc(bytes);
            memcpy(copy, p.samples, bytes); /* all of them are readable */
            free(copy);
        }
        picture_free(&p);
    }
    close(descriptor);
    return 0;
}
