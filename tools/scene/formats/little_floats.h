/* Converts floats of 32 and 64 bits to and from little-endian bytes. */
#ifndef TRIM3R_TOOLS_LITTLE_FLOATS_H
#define TRIM3R_TOOLS_LITTLE_FLOATS_H

#include <stdint.h>
#include <string.h>

#include "host/bytes.h"

static inline double load_float(const uint8_t *bytes)
{
    const uint32_t bits = t3r_load_le32(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline double load_double(const uint8_t *bytes)
{
    const uint64_t bits = t3r_load_le64(bytes);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Stores a double as a float, rounded to nearest. */
static inline void store_float(uint8_t *bytes, double value)
{
    const float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    t3r_store_le32(bytes, bits);
}

#endif
