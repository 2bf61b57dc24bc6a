/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures on disk: PNG (8-bit RGB or grey, 16-bit grey) through libpng, JPEG through libjpeg-turbo, HEIC and AVIF
 * through libheif. */
#ifndef TRIM3R_TOOLS_PICTURE_H
#define TRIM3R_TOOLS_PICTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PICTURE_LARGEST_SIDE 16384u /* of picture_read_large() */
#define PICTURE_LARGEST_PIXELS (UINT64_C(1) << 27)

typedef struct picture {
    uint32_t width, height;
    uint32_t channels; /* 3 = RGB, 1 = grey */
    uint32_t bits;     /* 8 or 16 */
    void *samples;     /* uint8_t or uint16_t (host order), rows without gaps; picture_free() */
    uint8_t *valid;    /* 8 bits: 0 for each pixel that alpha makes transparent by half or more; NULL: there is none */
    uint32_t orientation; /* 1 to 8 as EXIF defines it: how the stored pixels are to be turned; 1: not */
    double focal_35mm;    /* focal length in mm in terms of a 36 x 24 mm film, by EXIF; 0: unknown */
} picture;

/* Reads a picture. Returns 0, or -1 with "what, where" in error[]. Sizes over T3R_MAX_SIDE are refused. PNG palettes
 * become RGB; a 16-bit grey PNG stays 16 bits. A JPEG may lack its end marker, not a part of its pixels. */
int picture_read(const char *path, picture *out, char *error, size_t error_bytes);
/* The same up to PICTURE_LARGEST_SIDE and PICTURE_LARGEST_PIXELS. */
int picture_read_large(const char *path, picture *out, char *error, size_t error_bytes);
/* Do the same for a file's bytes in memory; "what" in error[]. */
int picture_parse(const uint8_t *bytes, size_t count, picture *out, char *error, size_t error_bytes);
int picture_parse_large(const uint8_t *bytes, size_t count, picture *out, char *error, size_t error_bytes);
/* Reads all but the samples from a picture's header: the sides, as they are stored, up to PICTURE_LARGEST_SIDE; errors
 * as above. */
int picture_header(const char *path, picture *out, char *error, size_t error_bytes);
/* Reads the stored sides alone. */
int picture_size(const char *path, uint32_t *width, uint32_t *height, char *error, size_t error_bytes);
int picture_write_png(const char *path, const picture *in, char *error, size_t error_bytes);
void picture_free(picture *p);

#endif
