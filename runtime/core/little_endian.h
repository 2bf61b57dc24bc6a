/* SPDX-License-Identifier: Apache-2.0 */
/* Integers in little-endian bytes: the same on every machine, at any alignment. */
#ifndef T3R_LITTLE_ENDIAN_H
#define T3R_LITTLE_ENDIAN_H

#include <stdint.h>

static inline uint16_t t3r_load_le16(const uint8_t *p)
{
    return (uint16_t)(p[0] | p[1] << 8);
}

static inline uint32_t t3r_load_le32(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static inline uint64_t t3r_load_le64(const uint8_t *p)
{
    return (uint64_t)t3r_load_le32(p) | (uint64_t)t3r_load_le32(p + 4) << 32;
}

static inline void t3r_store_le16(uint8_t *p, uint16_t x)
{
    p[0] = (uint8_t)x;
    p[1] = (uint8_t)(x >> 8);
}

static inline void t3r_store_le32(uint8_t *p, uint32_t x)
{
    t3r_store_le16(p, (uint16_t)x);
    t3r_store_le16(p + 2, (uint16_t)(x >> 16));
}

static inline void t3r_store_le64(uint8_t *p, uint64_t x)
{
    t3r_store_le32(p, (uint32_t)x);
    t3r_store_le32(p + 4, (uint32_t)(x >> 32));
}

/* Two bytes of an aligned table, read as one value, so that compilers vectorize loops over them. */
typedef int16_t __attribute__((may_alias)) t3r_le16;

static inline int16_t t3r_from_le16(t3r_le16 x)
{
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    return (int16_t)__builtin_bswap16((uint16_t)x);
#else
    return x;
#endif
}

#endif
