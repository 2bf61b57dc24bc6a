#include "fixed_double.h"

#include <string.h>

_Static_assert(sizeof(double) == 8, "double must be IEEE 754 binary64");

/* Converts mantissa x 2^exponent, round-half-even; mantissa < 2^53. */
static int scale(int negative, uint64_t mantissa, int32_t exponent, int64_t *fixed)
{
    uint64_t magnitude;
    if (exponent >= 0) {
        if (mantissa != 0 && (exponent > 62 || mantissa > (uint64_t)INT64_MAX >> exponent)) {
            return -1;
        }
        magnitude = mantissa == 0 ? 0 : mantissa << exponent;
    } else if (exponent < -54) {
        magnitude = 0; /* mantissa < 2^53, so the value is below 1/4 */
    } else {
        uint32_t shift = (uint32_t)-exponent;
        uint64_t half = (uint64_t)1 << (shift - 1);
        uint64_t rest = mantissa & (((uint64_t)1 << shift) - 1);
        magnitude = mantissa >> shift;
        if (rest > half || (rest == half && (magnitude & 1) != 0)) {
            magnitude++;
        }
    }
    *fixed = negative ? -(int64_t)magnitude : (int64_t)magnitude;
    return 0;
}

int t3r_fixed_from_double(uint64_t bits, uint32_t fraction_bits, int64_t *fixed)
{
    uint32_t biased = (uint32_t)(bits >> 52) & 0x7ff;
    uint64_t mantissa = bits & (((uint64_t)1 << 52) - 1);
    if (biased == 0x7ff) {
        return -1;
    }
    if (biased == 0) {
        biased = 1; /* zero and subnormals: no hidden bit */
    } else {
        mantissa |= (uint64_t)1 << 52;
    }
    return scale((int)(bits >> 63), mantissa, (int32_t)biased - 1075 + (int32_t)fraction_bits, fixed);
}

int t3r_fixed_from_float(uint32_t bits, uint32_t fraction_bits, int64_t *fixed)
{
    uint32_t biased = bits >> 23 & 0xff;
    uint32_t mantissa = bits & (((uint32_t)1 << 23) - 1);
    if (biased == 0xff) {
        return -1;
    }
    if (biased == 0) {
        biased = 1;
    } else {
        mantissa |= (uint32_t)1 << 23;
    }
    return scale((int)(bits >> 31), mantissa, (int32_t)biased - 150 + (int32_t)fraction_bits, fixed);
}

uint64_t t3r_double_bits(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}
