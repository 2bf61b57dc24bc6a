/* Q40 numbers as decimal text and back, in integers: how a recording's metadata names its depth unit. */
#ifndef T3R_PLATFORM_FIXED_TEXT_H
#define T3R_PLATFORM_FIXED_TEXT_H

#include <stdint.h>

#include "text.h"

#define T3R_Q40_TEXT_BYTES 32

/* "12", "0.001": digits, at most 18 of them behind the point; round-half-even. 0, or -1 when it is something else
 * or not below 2^24. */
int t3r_q40_from_text(t3r_text text, uint64_t *value_q40);

/* The shortest text that reads back as value_q40. */
void t3r_q40_to_text(uint64_t value_q40, char text[T3R_Q40_TEXT_BYTES]);

#endif
