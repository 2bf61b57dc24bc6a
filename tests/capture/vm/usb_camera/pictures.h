/* SPDX-License-Identifier: Apache-2.0 */
/* The images that the camera sends, from two files: YUYV images one after the other; JPEGs, each after its length in
 * four bytes, little-endian. */
#ifndef T3R_TESTS_USB_PICTURES_H
#define T3R_TESTS_USB_PICTURES_H

#include <stdint.h>

#define PICTURES_MOST 64u

typedef struct picture {
    const uint8_t *bytes;
    uint32_t count;
} picture;

typedef struct pictures {
    uint32_t yuyv_count, jpeg_count; /* at least 1 */
    picture yuyv[PICTURES_MOST], jpeg[PICTURES_MOST];
    uint8_t yuyv_bytes[2500000], jpeg_bytes[2500000];
} pictures;

/* Returns 0, or -1 if a file cannot be read or has another format. */
int pictures_read(pictures *self, const char *yuyv_path, const char *jpeg_path);

#endif
