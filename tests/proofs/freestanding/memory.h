/* SPDX-License-Identifier: Apache-2.0 */
/* The four functions that the runtime calls, for a program without a C library; one of its files includes them. */
#ifndef T3R_TESTS_FREESTANDING_MEMORY_H
#define T3R_TESTS_FREESTANDING_MEMORY_H

#include <stddef.h>
#include <stdint.h>

void *memcpy(void *restrict to, const void *restrict from, size_t count);
void *memmove(void *to, const void *from, size_t count);
void *memset(void *to, int byte, size_t count);
int memcmp(const void *a, const void *b, size_t count);

/* volatile: otherwise the compiler would turn the loops into calls of these functions */
void *memcpy(void *restrict to, const void *restrict from, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        ((volatile uint8_t *)to)[i] = ((const uint8_t *)from)[i];
    }
    return to;
}

void *memmove(void *to, const void *from, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        size_t k = (uintptr_t)to < (uintptr_t)from ? i : count - 1 - i;
        ((volatile uint8_t *)to)[k] = ((const uint8_t *)from)[k];
    }
    return to;
}

void *memset(void *to, int byte, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        ((volatile uint8_t *)to)[i] = (uint8_t)byte;
    }
    return to;
}

int memcmp(const void *a, const void *b, size_t count)
{
    const uint8_t *p = a, *q = b;
    for (size_t i = 0; i < count; i++) {
        if (p[i] != q[i]) {
            return p[i] < q[i] ? -1 : 1;
        }
    }
    return 0;
}

#endif
