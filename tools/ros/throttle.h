/* The same line again and again is told once in a while, with how many there were. */
#ifndef TRIM3R_TOOLS_THROTTLE_H
#define TRIM3R_TOOLS_THROTTLE_H

#include <stdbool.h>
#include <stdint.h>

#define THROTTLE_TEXT_BYTES 320
#define THROTTLE_INTERVAL_NS INT64_C(5000000000)

/* Starts with zeros. */
typedef struct throttle {
    char last[THROTTLE_TEXT_BYTES];
    int64_t told_ns;
    uint64_t held_back; /* since then */
} throttle;

/* Whether this line is told at that time; then *more is how many lines were held back since the last one. */
bool throttle_tells(throttle *t, const char *text, int64_t now_ns, uint64_t *more);

#endif
