/* SPDX-License-Identifier: Apache-2.0 */
/* For tests linked with the asserting runtime that misuse nothing: an assertion that fails ends the test. */
#include <stdio.h>
#include <stdlib.h>

#include "noted_assert.h"

void noted_assertion(void)
{
    fprintf(stderr, "an assertion of the runtime failed\n");
    abort();
}
