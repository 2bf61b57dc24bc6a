/* SPDX-License-Identifier: Apache-2.0 */
/* For tests linked with the asserting runtime that never misuse it: a failed assertion ends the test. */
#include <stdio.h>
#include <stdlib.h>

#include "noted_assert.h"

void noted_assertion(void)
{
    fprintf(stderr, "an assertion of the runtime failed\n");
    abort();
}
