/* Sets stored as bits of a word. */
#ifndef T3R_BITS_H
#define T3R_BITS_H

#include <stdint.h>

/* Returns the number of set bits, 0..32, without a branch. */
static inline uint32_t t3r_ones(uint32_t bits)
{
    bits -= bits >> 1 & 0x55555555u;
    bits = (bits & 0x33333333u) + (bits >> 2 & 0x33333333u);
    return ((bits + (bits >> 4)) & 0x0f0f0f0fu) * 0x01010101u >> 24;
}

#endif
