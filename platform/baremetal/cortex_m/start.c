/* SPDX-License-Identifier: Apache-2.0 */
/* From reset to main() on a Cortex-M: the vector table, initialised data, the painted stack. Symbols that end in _at
 * are addresses from sections.ld. */
#include <stdint.h>

#include "semihost.h"
#include "stack.h"

extern uint32_t data_load_at[], data_begin_at[], data_end_at[], zero_begin_at[], zero_end_at[];
extern uint32_t stack_top_at[];

int main(void);
_Noreturn void reset(void);
_Noreturn void fault(void);

_Noreturn void fault(void)
{
    semihost_print("error: the processor faulted\n");
    semihost_exit(2);
}

#if defined(__ARM_FP) || defined(__ARM_FEATURE_MVE)
/* Vectors use the registers of the floating-point unit, which is off after a reset. */
static void enable_vectors(void)
{
    volatile uint32_t *const access_control = (volatile uint32_t *)0xe000ed88; /* CPACR */
    *access_control |= 0xfu << 20;
    __asm__ volatile("dsb\n\tisb" ::: "memory");
}
#else
static void enable_vectors(void)
{
}
#endif

_Noreturn void reset(void)
{
    enable_vectors();
    for (uint32_t *from = data_load_at, *to = data_begin_at; to < data_end_at;) {
        *to++ = *from++;
    }
    for (uint32_t *to = zero_begin_at; to < zero_end_at;) {
        *to++ = 0;
    }
    stack_paint();
    semihost_exit(main());
}

/* Handlers that a firmware may define. */
void NMI_Handler(void) __attribute__((weak, alias("fault")));
void SysTick_Handler(void) __attribute__((weak, alias("fault")));

typedef void vector(void);
__attribute__((section(".vectors"), used)) static vector *const vectors[16] = {
    (vector *)(uintptr_t)stack_top_at,
    reset,
    NMI_Handler,
    fault, /* hard fault */
    fault, /* memory management */
    fault, /* bus */
    fault, /* usage */
    fault, /* secure */
    [15] = SysTick_Handler,
};
