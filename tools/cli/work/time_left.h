/* How long work goes on, by what has been done of it. */
#ifndef TRIM3R_TOOLS_TIME_LEFT_H
#define TRIM3R_TOOLS_TIME_LEFT_H

#include <stdint.h>

/* Seconds that the rest of `total` items takes at the rate of this run: `done` are done, `before` of them were there
 * already, the others took `elapsed` seconds. Negative as long as this run has done none and so nothing is known, 0
 * once all are done. */
double cli_time_left(uint32_t before, uint32_t done, uint32_t total, double elapsed);

#endif
