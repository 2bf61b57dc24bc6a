/* SPDX-License-Identifier: Apache-2.0 */
/* Any bytes as a picture: an error, or a picture of the size that its header gave. */
#ifndef T3R_FUZZ_PICTURE_BYTES_H
#define T3R_FUZZ_PICTURE_BYTES_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fuzz/memory_file.h"
#include "pictures/picture.h"

#define MOST_PIXELS (UINT64_C(1) << 20) /* so that a time limit finds slowness, not size */

/* Ends the program unless all samples are readable and as the fields state. */
static inline void try_samples(const picture *p)
{
    const size_t pixels = (size_t)p->width * p->height, bytes = pixels * p->channels * (p->bits / 8);
    void *copy = malloc(bytes);
    memcpy(copy, p->samples, bytes);
    if ((p->channels != 1 && p->channels != 3) || (p->bits != 8 && p->bits != 16)) {
        abort();
    }
    for (size_t i = 0; i < pixels && p->valid != NULL; i++) {
        if (p->valid[i] > 1) {
            abort();
        }
    }
    free(copy);
}

static inline void try_picture(const uint8_t *data, size_t size)
{
    char path[MEMORY_FILE_PATH_BYTES], error[256] = "";
    int descriptor = memory_file(data, size, path);
    picture header = {0}, p;
    int status = picture_header(path, &header, error, sizeof error);
    if ((status != 0) != (error[0] != '\0') || (status == 0 && (header.width < 1 || header.height < 1)) ||
        header.width > PICTURE_LARGEST_SIDE || header.height > PICTURE_LARGEST_SIDE) {
        abort();
    }
    if (status == 0 && (uint64_t)header.width * header.height <= MOST_PIXELS) {
        status = picture_read_large(path, &p, error, sizeof error);
        if ((status != 0) != (error[0] != '\0') ||
            (status == 0 &&
             (p.width != header.width || p.height != header.height || p.orientation != header.orientation ||
              p.orientation < 1 || p.orientation > 8 || !(p.focal_35mm >= 0)))) {
            abort();
        }
        if (status == 0) {
            try_samples(&p);
        }
        picture_free(&p);
    }
    close(descriptor);
}

#endif
