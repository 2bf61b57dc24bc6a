/* SPDX-License-Identifier: Apache-2.0 */
/* The parts of RAM, placed by the linker. */
#ifndef T3R_BAREMETAL_RAM_H
#define T3R_BAREMETAL_RAM_H

#include <stdint.h>

typedef struct ram_part {
    uint8_t *begin, *end;
} ram_part;

/* Returns the variables, initialised or not. */
ram_part ram_data(void);
/* Returns the memory that main() allocates from; it begins at a multiple of T3R_ARENA_ALIGN. */
ram_part ram_free(void);
/* Returns the stack, which grows from its end to its beginning. Both are multiples of 4. */
ram_part ram_stack(void);

#endif
