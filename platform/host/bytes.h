/* Integers to and from bytes by shifts: the same on hosts of either byte order, at any alignment. */
#ifndef T3R_PLATFORM_BYTES_H
#define T3R_PLATFORM_BYTES_H

#include <stdint.h>

static inline uint16_t t3r_load_le16(const uint8_t *b)
{
    return (uint16_t)(b[0] | b[1] << 8);
}

static inline uint32_t t3r_load_le32(const uint8_t *b)
{
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static inline uint64_t t3r_load_le64(const uint8_t *b)
{
    return (uint64_t)t3r_load_le32(b) | (uint64_t)t3r_load_le32(b + 4) << 32;
}

static inline uint32_t t3r_load_be32(const uint8_t *b)
{
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | (uint32_t)b[3];
}

static inline uint64_t t3r_load_be64(const uint8_t *b)
{
    return (uint64_t)t3r_load_be32(b) << 32 | (uint64_t)t3r_load_be32(b + 4);
}

static inline void t3r_store_le16(uint8_t *b, uint16_t x)
{
    b[0] = (uint8_t)x;
    b[1] = (uint8_t)(x >> 8);
}

static inline void t3r_store_le32(uint8_t *b, uint32_t x)
{
    t3r_store_le16(b, (uint16_t)x);
    t3r_store_le16(b + 2, (uint16_t)(x >> 16));
}

static inline void t3r_store_le64(uint8_t *b, uint64_t x)
{
    t3r_store_le32(b, (uint32_t)x);
    t3r_store_le32(b + 4, (uint32_t)(x >> 32));
}

#endif
