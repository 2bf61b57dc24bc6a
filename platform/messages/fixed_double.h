/* Converts IEEE 754 doubles and floats, given as bits, to fixed point: round-half-even, range-checked, integers only,
 * so that the result is the same on every processor and with every math library. */
#ifndef T3R_PLATFORM_FIXED_DOUBLE_H
#define T3R_PLATFORM_FIXED_DOUBLE_H

#include <stdint.h>

/* Writes round-half-even(value x 2^fraction_bits) to *fixed; fraction_bits 0..62. Returns 0, or -1 (and *fixed
 * untouched) for NaN, infinities, and results outside [-INT64_MAX, INT64_MAX]. */
int t3r_fixed_from_double(uint64_t bits, uint32_t fraction_bits, int64_t *fixed);
int t3r_fixed_from_float(uint32_t bits, uint32_t fraction_bits, int64_t *fixed);

/* Returns the bits of a double of this process. */
uint64_t t3r_double_bits(double value);

#endif
