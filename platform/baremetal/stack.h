/* How deep the stack went: it is painted before main(), and the paint that is left is counted. */
#ifndef T3R_BAREMETAL_STACK_H
#define T3R_BAREMETAL_STACK_H

#include <stdint.h>

/* Paints what lies below the caller's frame. */
void stack_paint(void);
/* The most bytes that were used so far; all of them where no paint is left, which may be an overflow. */
uint32_t stack_used_bytes(void);
/* The bytes that there are. */
uint32_t stack_bytes(void);

#endif
