/* SPDX-License-Identifier: Apache-2.0 */
/* The functions of zlib that the reader of recordings calls, without the library. */
#ifndef TRIM3R_TOOLS_VIEWER_ZLIB_H
#define TRIM3R_TOOLS_VIEWER_ZLIB_H

#include <stdint.h>

#include "mcap/crc32.h"

typedef int64_t z_off_t;

static inline uint32_t crc32_z(uint32_t crc, const void *bytes, size_t count)
{
    return t3r_crc32(crc, bytes, count);
}

/* Returns the product of two polynomials modulo that of the CRC; bit 31 is x^0. */
static inline uint32_t crc32_product(uint32_t a, uint32_t b)
{
    uint32_t product = 0;
    for (uint32_t bit = UINT32_C(1) << 31; bit != 0; bit >>= 1) {
        product ^= (a & bit) != 0 ? b : 0;
        b = (b >> 1) ^ ((b & 1) != 0 ? UINT32_C(0xedb88320) : 0);
    }
    return product;
}

/* Returns the CRC of bytes with the CRC `a`, followed by `count` bytes with the CRC `b`. */
static inline uint32_t crc32_combine(uint32_t a, uint32_t b, z_off_t count)
{
    uint32_t power = UINT32_C(1) << 23; /* x^8, then its squares */
    for (uint64_t rest = (uint64_t)count; rest != 0; rest >>= 1) {
        a = (rest & 1) != 0 ? crc32_product(a, power) : a;
        power = crc32_product(power, power);
    }
    return a ^ b;
}

#endif
