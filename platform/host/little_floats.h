/* SPDX-License-Identifier: Apache-2.0 */
/* Floats of 32 and 64 bits in little-endian bytes, for hosts; the counterpart of little_endian.h. */
#ifndef T3R_PLATFORM_LITTLE_FLOATS_H
#define T3R_PLATFORM_LITTLE_FLOATS_H

#include <string.h>

#include "core/little_endian.h"

static inline float t3r_load_float(const uint8_t *bytes)
{
    const uint32_t bits = t3r_load_le32(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline double t3r_load_double(const uint8_t *bytes)
{
    const uint64_t bits = t3r_load_le64(bytes);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Stores a float, rounded to nearest. */
static inline void t3r_store_float(uint8_t *bytes, double value)
{
    const float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    t3r_store_le32(bytes, bits);
}

#endif
