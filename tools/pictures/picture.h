/* Pictures on disk: PNG (8-bit RGB or grey, 16-bit grey) through libpng, JPEG through libjpeg-turbo. */
#ifndef TRIM3R_TOOLS_PICTURE_H
#define TRIM3R_TOOLS_PICTURE_H

#include <stddef.h>
#include <stdint.h>

typedef struct picture {
    uint32_t width, height;
    uint32_t channels; /* 3 = RGB, 1 = grey */
    uint32_t bits;     /* 8 or 16 */
    void *samples;     /* uint8_t or uint16_t (host order), rows without gaps; picture_free() */
} picture;

/* Reads a picture. Returns 0, or -1 with "what, where" in error[]. Sizes over T3R_MAX_SIDE are refused. PNG palettes
 * and alpha become RGB; a 16-bit grey PNG stays 16 bits. */
int picture_read(const char *path, picture *out, char *error, size_t error_bytes);
/* The same for a file's bytes in memory; "what" in error[]. */
int picture_parse(const uint8_t *bytes, size_t count, picture *out, char *error, size_t error_bytes);
/* Reads the sides of a picture from its header without decoding; errors as above. */
int picture_size(const char *path, uint32_t *width, uint32_t *height, char *error, size_t error_bytes);
int picture_write_png(const char *path, const picture *in, char *error, size_t error_bytes);
void picture_free(picture *p);

#endif
