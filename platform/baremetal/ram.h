/* The parts of RAM, as the linker placed them. */
#ifndef T3R_BAREMETAL_RAM_H
#define T3R_BAREMETAL_RAM_H

#include <stdint.h>

typedef struct ram_part {
    uint8_t *begin, *end;
} ram_part;

/* Variables, with a value at first or without. */
ram_part ram_data(void);
/* What main() deals out; it begins at a multiple of T3R_ARENA_ALIGN. */
ram_part ram_free(void);
/* It grows from its end to its beginning. Both are multiples of 4. */
ram_part ram_stack(void);

#endif
