/* SPDX-License-Identifier: Apache-2.0 */
/* Estimates the remaining time of work from its progress. */
#ifndef TRIM3R_TOOLS_TIME_LEFT_H
#define TRIM3R_TOOLS_TIME_LEFT_H

#include <stdint.h>

/* Returns the seconds for the rest of `total` items at the rate of this run: `done` are done, of which `before` were
 * there already and the others took `elapsed` seconds. Negative while this run has done none, 0 once all are done. */
double cli_time_left(uint32_t before, uint32_t done, uint32_t total, double elapsed);

#endif
