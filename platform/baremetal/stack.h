/* SPDX-License-Identifier: Apache-2.0 */
/* Measures the depth of the stack: it is painted before main(), and the paint that is left is counted. */
#ifndef T3R_BAREMETAL_STACK_H
#define T3R_BAREMETAL_STACK_H

#include <stdint.h>

/* Paints the stack below the caller's frame. */
void stack_paint(void);
/* Returns the most bytes used so far; all bytes if no paint is left, which may be an overflow. */
uint32_t stack_used_bytes(void);
uint32_t stack_bytes(void);

#endif
