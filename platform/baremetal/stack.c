#include "stack.h"

#define PAINT UINT32_C(0xdeadbeef)
#define SPARED_BYTES 64 /* of this function's own frame and its caller's */

extern uint32_t stack_bottom_at[], stack_top_at[];

void stack_paint(void)
{
    const uintptr_t end = (uintptr_t)__builtin_frame_address(0) - SPARED_BYTES;
    for (volatile uint32_t *word = stack_bottom_at; (uintptr_t)word < end; word++) {
        *word = PAINT;
    }
}

uint32_t stack_used_bytes(void)
{
    const uint32_t *word = stack_bottom_at;
    while (word < stack_top_at && *word == PAINT) {
        word++;
    }
    return (uint32_t)((const uint8_t *)stack_top_at - (const uint8_t *)word);
}

uint32_t stack_bytes(void)
{
    return (uint32_t)((const uint8_t *)stack_top_at - (const uint8_t *)stack_bottom_at);
}
