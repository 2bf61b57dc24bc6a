/* SPDX-License-Identifier: Apache-2.0 */
/* The result of a stress test in a few lines: invariants, refusals, and trim3r against the best rival. */
#ifndef TRIM3R_TOOLS_STRESS_VERDICT_H
#define TRIM3R_TOOLS_STRESS_VERDICT_H

#include "study/stress/measure.h"

/* Returns the number of rows with a broken invariant. */
uint32_t stress_broken(const stress_row *rows, uint32_t count);

/* Prints each broken invariant, refusals with their reasons, time, stability, flicker; with trim3r and rivals also
 * the losses at the middle strength of noise, exposure, depth dropouts and pose, and whether the loss of trim3r is
 * at most half. */
void stress_print_verdict(FILE *out, const stress_row *rows, uint32_t count, const stress_contest *contest);

#endif
