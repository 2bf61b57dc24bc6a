/* SPDX-License-Identifier: Apache-2.0 */
/* Prints a repeated line only now and then, with the number of suppressed ones. */
#ifndef TRIM3R_TOOLS_THROTTLE_H
#define TRIM3R_TOOLS_THROTTLE_H

#include <stdbool.h>
#include <stdint.h>

#define THROTTLE_TEXT_BYTES 320
#define THROTTLE_INTERVAL_NS INT64_C(5000000000)

/* Initialise with zeros. */
typedef struct throttle {
    char last[THROTTLE_TEXT_BYTES];
    int64_t last_ns;
    uint64_t held_back; /* lines suppressed since then */
} throttle;

/* Whether to print this line at that time; *more is the number of lines suppressed since the last one. */
bool throttle_passes(throttle *t, const char *text, int64_t now_ns, uint64_t *more);

#endif
