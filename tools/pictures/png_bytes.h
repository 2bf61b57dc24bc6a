/* Encodes a picture as the bytes of a PNG file. */
#ifndef TRIM3R_TOOLS_PNG_BYTES_H
#define TRIM3R_TOOLS_PNG_BYTES_H

#include <stddef.h>
#include <stdint.h>

/* Encodes samples. channels: 3 = RGB, 1 = grey; rows without gaps. Returns NULL without memory; free() the result. */
uint8_t *png_bytes(uint32_t width, uint32_t height, uint32_t channels, const uint8_t *samples, size_t *count);

#endif
