/* SPDX-License-Identifier: Apache-2.0 */
/* Planted: a header of the C library. */
#include <string.h>

void planted_clear(void *bytes, size_t count);

void planted_clear(void *bytes, size_t count)
{
    memset(bytes, 0, count);
}
