/* SPDX-License-Identifier: Apache-2.0 */
/* fixed.h with the contracts of contracts.h, for WP. */
#include "contracts.h"

#include "core/fixed.h"

int main(void)
{
    return t3r_abs32(0);
}
