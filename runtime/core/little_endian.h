/* Little-endian numbers, as in weight files and hashes, on any machine. */
#ifndef T3R_LITTLE_ENDIAN_H
#define T3R_LITTLE_ENDIAN_H

#include <stdint.h>

static inline uint32_t t3r_le_u16(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8;
}

static inline uint32_t t3r_le_u32(const uint8_t *p)
{
    return t3r_le_u16(p) | t3r_le_u16(p + 2) << 16;
}

static inline int32_t t3r_le_i32(const uint8_t *p)
{
    return (int32_t)t3r_le_u32(p);
}

static inline int64_t t3r_le_i64(const uint8_t *p)
{
    return (int64_t)((uint64_t)t3r_le_u32(p) | (uint64_t)t3r_le_u32(p + 4) << 32);
}

static inline void t3r_set_le_u16(uint8_t *p, uint16_t x)
{
    p[0] = (uint8_t)x;
    p[1] = (uint8_t)(x >> 8);
}

static inline void t3r_set_le_u32(uint8_t *p, uint32_t x)
{
    t3r_set_le_u16(p, (uint16_t)x);
    t3r_set_le_u16(p + 2, (uint16_t)(x >> 16));
}

/* Two bytes of an aligned table, read as one value so that a loop over them becomes vector loads. */
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
