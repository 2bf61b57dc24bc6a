/* Room for one more item in a heap array. */
#ifndef T3R_PLATFORM_GROW_H
#define T3R_PLATFORM_GROW_H

#include <stdint.h>
#include <stdlib.h>

/* Returns the array with room for at least count + 1 items of `size` bytes. Returns NULL when memory is out; the old
 * array then stays valid. */
static inline void *t3r_grow(void *items, size_t count, size_t *capacity, size_t size)
{
    if (count < *capacity) {
        return items;
    }
    size_t more = *capacity < 8 ? 16 : *capacity * 2;
    if (more > SIZE_MAX / 2 / size) {
        return NULL;
    }
    void *grown = realloc(items, more * size);
    if (grown != NULL) {
        *capacity = more;
    }
    return grown;
}

#endif
