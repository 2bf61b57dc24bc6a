#include "stack.h"

#include "ram.h"

#define PAINT UINT32_C(0xdeadbeef)
#define SPARED_BYTES 64 /* frames of this function and its caller */

void stack_paint(void)
{
    const uintptr_t end = (uintptr_t)__builtin_frame_address(0) - SPARED_BYTES;
    for (volatile uint32_t *word = (volatile uint32_t *)ram_stack().begin; (uintptr_t)word < end; word++) {
        *word = PAINT;
    }
}

uint32_t stack_used_bytes(void)
{
    const ram_part stack = ram_stack();
    const uint32_t *word = (const uint32_t *)stack.begin, *end = (const uint32_t *)stack.end;
    while (word < end && *word == PAINT) {
        word++;
    }
    return (uint32_t)((const uint8_t *)end - (const uint8_t *)word);
}

uint32_t stack_bytes(void)
{
    const ram_part stack = ram_stack();
    return (uint32_t)(stack.end - stack.begin);
}
