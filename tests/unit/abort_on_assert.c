/* For tests that link the asserting runtime and use it correctly: a failed assertion ends the test. */
#include <stdio.h>
#include <stdlib.h>

#include "noted_assert.h"

void noted_assertion(void)
{
    fprintf(stderr, "an assertion of the runtime failed\n");
    abort();
}
