#include "ram.h"

#include "trim3r.h"

/* As much as the largest picture of tools/everywhere needs. */
static _Alignas(T3R_ARENA_ALIGN) uint8_t memory[16 << 20];

ram_part ram_free(void)
{
    return (ram_part){memory, memory + sizeof memory};
}

/* The operating system's, which nobody measures here. */

ram_part ram_data(void)
{
    return (ram_part){memory, memory};
}

ram_part ram_stack(void)
{
    return (ram_part){memory, memory};
}
