/* Numbers as single bytes, for several formats. */
#ifndef TRIM3R_TOOLS_BYTE_CODES_H
#define TRIM3R_TOOLS_BYTE_CODES_H

#include <math.h>
#include <stdint.h>

/* Returns the nearest of 0..255. */
static inline uint8_t byte_of(double value)
{
    return (uint8_t)(value <= 0 ? 0 : value >= 255 ? 255 : nearbyint(value));
}

/* Returns the logit of an opacity in 255ths; infinities at the ends. */
static inline double logit_of_byte(uint8_t byte)
{
    return log(byte / 255.0) - log(1 - byte / 255.0);
}

#endif
