/* SPDX-License-Identifier: Apache-2.0 */
/* Motion JPEG: decodes one picture into RGB, in integers that are the same for every version of libjpeg-turbo (slow,
 * exact inverse DCT; plain upsampling). The library allocates while it works. */
#ifndef T3R_PLATFORM_MJPEG_H
#define T3R_PLATFORM_MJPEG_H

#include <stddef.h>
#include <stdint.h>

typedef struct t3r_mjpeg t3r_mjpeg;

/* Returns NULL when memory is out. */
t3r_mjpeg *t3r_mjpeg_open(void);
void t3r_mjpeg_close(t3r_mjpeg *decoder);
/* Decodes a JPEG of exactly width x height into rgb (3 bytes a pixel, rows without gaps). Returns NULL, or what is
 * wrong. libjpeg's warnings are errors too, since pixels are missing then. */
const char *t3r_mjpeg_decode(t3r_mjpeg *decoder, const uint8_t *jpeg, size_t bytes, uint32_t width, uint32_t height,
                             uint8_t *rgb);

#endif
