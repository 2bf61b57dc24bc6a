/* Lossless WebP as a table of four bytes per texel. In a build without libwebp both functions fail. */
#ifndef TRIM3R_TOOLS_WEBP_TEXELS_H
#define TRIM3R_TOOLS_WEBP_TEXELS_H

#include <stddef.h>
#include <stdint.h>

typedef struct webp_texels {
    uint32_t width, height;
    uint8_t *rgba; /* rows without gaps; webp_texels_free() */
} webp_texels;

/* Each returns 0, or -1 with the reason in error[]. Pictures of more than `most` texels are refused before decoding. */
int webp_texels_read(const uint8_t *bytes, size_t count, uint64_t most, webp_texels *out, char *error,
                     size_t error_bytes);
/* The caller must free() *bytes. */
int webp_texels_write(const webp_texels *texels, uint8_t **bytes, size_t *count, char *error, size_t error_bytes);
void webp_texels_free(webp_texels *texels);

#endif
