/* CRC-32 (IEEE 802.3, reflected, as in zlib and MCAP) for the recorder, which calls no library. Readers use zlib's. */
#ifndef T3R_PLATFORM_CRC32_H
#define T3R_PLATFORM_CRC32_H

#include <stddef.h>
#include <stdint.h>

/* Extends a CRC by more bytes; start with crc = 0, then pass the previous result. */
uint32_t t3r_crc32(uint32_t crc, const void *bytes, size_t count);

#endif
