#include "ram.h"

#include "trim3r.h"

/* Enough for the largest picture of tools/everywhere. */
static _Alignas(T3R_ARENA_ALIGN) uint8_t memory[16 << 20];

ram_part ram_free(void)
{
    return (ram_part){memory, memory + sizeof memory};
}

/* The operating system's stack and data are not measured here. */

ram_part ram_data(void)
{
    return (ram_part){memory, memory};
}

ram_part ram_stack(void)
{
    return (ram_part){memory, memory};
}
