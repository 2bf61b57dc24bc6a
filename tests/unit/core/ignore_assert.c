/* SPDX-License-Identifier: Apache-2.0 */
/* For tests that misuse the runtime on purpose, and check its return values. */
#include "noted_assert.h"

void noted_assertion(void)
{
}
