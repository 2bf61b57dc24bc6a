/* For tests that misuse the runtime on purpose and check what it returns. */
#include "noted_assert.h"

void noted_assertion(void)
{
}
