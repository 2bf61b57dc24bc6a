/* SPDX-License-Identifier: Apache-2.0 */
/* What is mutated and what is not: x + 1 < 2 in a comment stays. */
#include <stdint.h>
#define LONGER(x)                                                                                                      \
    do {                                                                                                               \
        (x) += 1;                                                                                                      \
    } while (x < 2)

typedef struct pair {
    int32_t both[2];
} pair;

static const char text[] = "a + 1"; // and - 1

static int64_t sums(const pair *of, uint32_t shift)
{
    T3R_BOUND(shift > 0 && shift < 31);
    _Static_assert(sizeof *of >= 8, "1 + 1");
    int64_t sum = (int64_t)of->both[0] * -of->both[1];
    if (!shift) {
        sum += '+';
    }
    sum = (sum + 0x8u) >> shift;
    return T3R_MIN(sum, INT64_C(5));
}

static const double real = 0.5;

static const uint8_t table[33] = {10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 10,
                                  0,  0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 10};
