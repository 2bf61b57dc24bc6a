/* SPDX-License-Identifier: Apache-2.0 */
/* A rounding shift that rounds down although its contract rounds to nearest. */
#include <stdint.h>

/*@ requires 0 < shift <= 30 && 0 <= x <= 1000;
    assigns \nothing;
    ensures rounded: \result == (x + (1 << (shift - 1))) >> shift; */
static int32_t down(int32_t x, uint32_t shift)
{
    return x >> shift;
}

int main(void)
{
    return down(3, 1);
}
