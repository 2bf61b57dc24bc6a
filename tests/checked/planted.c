/* SPDX-License-Identifier: Apache-2.0 */
/* Violates bounds, one per argument. */
#include <stdlib.h>

#include "core/divisor.h"
#include "core/fixed.h"

int main(int argc, char **argv)
{
    volatile int32_t zero = 0, largest = INT32_MAX;
    const int kind = argc > 1 ? atoi(argv[1]) : 0;
    switch (kind) {
    case 1:
        return t3r_round_div32(1, zero) == 7;
    case 2:
        return t3r_scale64(largest, 40) == 7;
    case 3:
        return t3r_divisor_of((uint32_t)zero).d == 7;
    case 4:
        return t3r_exp2_q16(largest) == 7;
    case 5:
        return largest + argc == 7;
    case 6:
        return argc / zero == 7;
    default:
        return 0;
    }
}
