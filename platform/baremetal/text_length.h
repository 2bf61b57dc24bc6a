/* Returns the length of a text in a few bytes of code: a C library's strlen() is written for speed. */
#ifndef T3R_BAREMETAL_TEXT_LENGTH_H
#define T3R_BAREMETAL_TEXT_LENGTH_H

#include <stddef.h>

static inline size_t text_length(const char *text)
{
    const volatile char *end = text; /* volatile, or the compiler turns the loop into strlen() */
    while (*end != '\0') {
        end++;
    }
    return (size_t)(end - text);
}

#endif
