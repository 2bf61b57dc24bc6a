/* SPDX-License-Identifier: Apache-2.0 */
#include <stddef.h>

void *malloc(size_t bytes);
void *planted_heap(size_t bytes);

void *planted_heap(size_t bytes)
{
    return malloc(bytes);
}
