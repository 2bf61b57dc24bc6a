/* SPDX-License-Identifier: Apache-2.0 */
/* Planted: an argument that the function's T3R_BOUND forbids. */
#include "core/fixed.h"

int main(void)
{
    return t3r_abs32((int32_t)t3r_any(INT32_MIN, 0)) > 0;
}
