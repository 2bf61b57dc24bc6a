/* SPDX-License-Identifier: Apache-2.0 */
#include "ram.h"

#include "trim3r.h"

/* The linker's own names: static data, then the stack, then the rest. */
extern uint8_t data_begin_at[] __asm__("__global_base"), data_end_at[] __asm__("__data_end"),
    stack_top_at[] __asm__("__heap_base");

enum { PAGE_BYTES = 65536, STACK_ALIGN = 16 };

static uint8_t *aligned(const uint8_t *at, uintptr_t to)
{
    return (uint8_t *)(((uintptr_t)at + to - 1) / to * to);
}

ram_part ram_data(void)
{
    return (ram_part){data_begin_at, data_end_at};
}

ram_part ram_free(void)
{
    return (ram_part){aligned(stack_top_at, T3R_ARENA_ALIGN), (uint8_t *)(__builtin_wasm_memory_size(0) * PAGE_BYTES)};
}

ram_part ram_stack(void)
{
    return (ram_part){aligned(data_end_at, STACK_ALIGN), stack_top_at};
}
