/* CRC-32 (IEEE 802.3, reflected, as zlib and MCAP use it), for the recorder, which calls no library. Readers have
 * zlib's. */
#ifndef T3R_PLATFORM_CRC32_H
#define T3R_PLATFORM_CRC32_H

#include <stddef.h>
#include <stdint.h>

/* The CRC of more bytes: start with crc = 0, then hand the last result on. */
uint32_t t3r_crc32(uint32_t crc, const void *bytes, size_t count);

#endif
