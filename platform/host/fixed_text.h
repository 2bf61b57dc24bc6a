/* Converts Q40 numbers to decimal text and back, in integers: the depth unit in a recording's metadata. */
#ifndef T3R_PLATFORM_FIXED_TEXT_H
#define T3R_PLATFORM_FIXED_TEXT_H

#include <stdint.h>

#include "text.h"

#define T3R_Q40_TEXT_BYTES 32

/* Parses "12" or "0.001": digits, at most 18 of them after the point; round-half-even. Returns 0, or -1 for anything
 * else and for values of 2^24 or more. */
int t3r_q40_from_text(t3r_text text, uint64_t *value_q40);

/* Writes the shortest text that reads back as value_q40. */
void t3r_q40_to_text(uint64_t value_q40, char text[T3R_Q40_TEXT_BYTES]);

#endif
