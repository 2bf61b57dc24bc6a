/* SPDX-License-Identifier: Apache-2.0 */
/* platform/messages/fixed_double.c: all doubles to 10..50 bits of fraction, and floats to those of depth; one exponent
 * at a time where it decides a shift. */
#include "messages/fixed_double.h"

static void doubles(uint64_t low, uint64_t high, uint32_t fraction_bits)
{
    int64_t fixed;
    t3r_fixed_from_double(t3r_any_unsigned(low << 52, (high << 52) + ((UINT64_C(1) << 52) - 1)), fraction_bits, &fixed);
}

static void floats(uint32_t low, uint32_t high)
{
    int64_t fixed;
    t3r_fixed_from_float((uint32_t)t3r_any_unsigned(low << 23, (high << 23) + ((1u << 23) - 1)), 40, &fixed);
}

int main(void)
{
    for (uint32_t fraction_bits = 10; fraction_bits <= 50; fraction_bits++) {
        for (uint32_t sign = 0; sign <= 2048; sign += 2048) {
            doubles(sign, sign, fraction_bits);
            doubles(sign + 1, sign + 970, fraction_bits); /* below a quarter of the last bit */
            for (uint32_t exponent = sign + 971; exponent < sign + 1130; exponent++) {
                doubles(exponent, exponent, fraction_bits);
            }
            doubles(sign + 1130, sign + 2046, fraction_bits); /* beyond every fraction */
            doubles(sign + 2047, sign + 2047, fraction_bits);
        }
    }
    for (uint32_t exponent = 0; exponent < 512; exponent++) {
        floats(exponent, exponent);
    }
    return 0;
}
