/* SPDX-License-Identifier: Apache-2.0 */
/* What a stress test says in a few lines: invariants, refusals, and ours against the best rival. */
#ifndef TRIM3R_TOOLS_STRESS_VERDICT_H
#define TRIM3R_TOOLS_STRESS_VERDICT_H

#include "study/stress/measure.h"

/* Rows whose invariant is broken. */
uint32_t stress_broken(const stress_row *rows, uint32_t count);

/* Broken invariants each, refusals with their reasons, time, stability, flicker; with trim3r and rivals: the losses at
 * the middle strength of noise, exposure, depth dropouts and pose, and whether ours is at most half. */
void stress_print_verdict(FILE *out, const stress_row *rows, uint32_t count, const stress_contest *contest);

#endif
