/* SPDX-License-Identifier: Apache-2.0 */
/* runtime/core/divisor.h and the inline functions of logarithm.h over their domains: every divisor from 1 to 2^30, one
 * power of two after another, because the shift follows from the size of the divisor. */
#include "core/divisor.h"
#include "core/logarithm.h"

int main(void)
{
    for (uint32_t bits = 0; bits <= 30; bits++) {
        const uint32_t low = 1u << bits, high = bits == 30 ? low : 2 * low - 1;
        const t3r_divisor by = t3r_divisor_of((uint32_t)t3r_any(low, high));
        t3r_divide_q24(&by, t3r_any(1 - (INT64_C(1) << 32), (INT64_C(1) << 32) - 1), (uint32_t)t3r_any(0, 16));
    }
    t3r_log2_inline_q16((uint32_t)t3r_any(1, UINT32_MAX));
    t3r_exp2_of_q10((int32_t)t3r_any(-16 * 1024, 0));
    return 0;
}
