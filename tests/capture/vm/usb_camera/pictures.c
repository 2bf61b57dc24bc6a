/* SPDX-License-Identifier: Apache-2.0 */
#include "pictures.h"

#include <stdio.h>

#include "camera.h"
#include "little_endian.h"

/* Reads a file; returns its bytes, 0 if there are none or more than fit. */
static uint32_t read_file(const char *path, uint8_t *bytes, size_t most)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return 0;
    }
    size_t count = fread(bytes, 1, most, file);
    count = feof(file) || fgetc(file) == EOF ? count : 0;
    fclose(file);
    return (uint32_t)count;
}

int pictures_read(pictures *self, const char *yuyv_path, const char *jpeg_path)
{
    uint32_t bytes = read_file(yuyv_path, self->yuyv_bytes, sizeof self->yuyv_bytes), at = 0;
    self->yuyv_count = self->jpeg_count = 0;
    for (; at + CAMERA_YUYV_BYTES <= bytes && self->yuyv_count < PICTURES_MOST; at += CAMERA_YUYV_BYTES) {
        self->yuyv[self->yuyv_count++] = (picture){self->yuyv_bytes + at, CAMERA_YUYV_BYTES};
    }
    if (self->yuyv_count == 0 || at != bytes) {
        return -1;
    }
    bytes = read_file(jpeg_path, self->jpeg_bytes, sizeof self->jpeg_bytes);
    at = 0;
    while (at + 4 <= bytes && self->jpeg_count < PICTURES_MOST) {
        uint32_t count = get_le(self->jpeg_bytes + at, 4);
        if (count == 0 || count > CAMERA_YUYV_BYTES || count > bytes - at - 4) {
            return -1;
        }
        self->jpeg[self->jpeg_count++] = (picture){self->jpeg_bytes + at + 4, count};
        at += 4 + count;
    }
    return self->jpeg_count > 0 && at == bytes ? 0 : -1;
}
