/* SPDX-License-Identifier: Apache-2.0 */
/* Runs this program's bench and another program's in turns, and compares the speed of each stage. */
#ifndef TRIM3R_TOOLS_BENCH_AGAINST_H
#define TRIM3R_TOOLS_BENCH_AGAINST_H

#include <stdbool.h>
#include <stdint.h>

#include "bench/bench_stages.h"

#define BENCH_TURNS_MOST 101u
#define BENCH_PASSED_MOST 8

typedef struct bench_contest {
    const char *other;                     /* path of the other program */
    const bool *chosen;                    /* of bench_stages */
    uint32_t turns;                        /* 1..BENCH_TURNS_MOST */
    const char *passed[BENCH_PASSED_MOST]; /* options passed to both, such as "--threads=2" */
    uint32_t passed_count;
    bool json;
} bench_contest;

/* Prints the table or one JSON object. Returns an exit status of cli.h, after a message. */
int bench_against(const bench_contest *contest);

#endif
