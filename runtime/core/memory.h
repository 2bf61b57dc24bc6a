/* SPDX-License-Identifier: Apache-2.0 */
/* The four functions that the runtime calls and does not define: from a C library, or the firmware's own. Declared
 * here, so that no C library's header is needed. */
#ifndef T3R_CORE_MEMORY_H
#define T3R_CORE_MEMORY_H

#include <stddef.h>

#ifdef __GNUC__
#pragma GCC visibility push(default) /* external even if everything else is hidden */
#endif
void *memcpy(void *restrict to, const void *restrict from, size_t count);
void *memmove(void *to, const void *from, size_t count);
void *memset(void *to, int byte, size_t count);
int memcmp(const void *a, const void *b, size_t count);
#ifdef __GNUC__
#pragma GCC visibility pop
#endif

#endif
