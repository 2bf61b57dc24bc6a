/* Numbers in a file's bytes, little-endian on every machine. */
#ifndef T3R_QUANT_LE_BYTES_H
#define T3R_QUANT_LE_BYTES_H

#include <stdint.h>

/* Writes the low `bytes` of value. */
static inline void le_put(uint8_t *to, uint64_t value, uint32_t bytes)
{
    for (uint32_t i = 0; i < bytes; i++) {
        to[i] = (uint8_t)(value >> (8 * i));
    }
}

static inline uint64_t le_get(const uint8_t *from, uint32_t bytes)
{
    uint64_t value = 0;
    for (uint32_t i = 0; i < bytes; i++) {
        value |= (uint64_t)from[i] << (8 * i);
    }
    return value;
}

/* Reads the same as two's complement. */
static inline int64_t le_get_signed(const uint8_t *from, uint32_t bytes)
{
    uint64_t value = le_get(from, bytes), sign = UINT64_C(1) << (8 * bytes - 1);
    return (int64_t)((value ^ sign) - sign);
}

#endif
