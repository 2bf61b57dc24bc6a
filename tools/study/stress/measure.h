/* SPDX-License-Identifier: Apache-2.0 */
/* Measures the methods on one case under one perturbation. */
#ifndef TRIM3R_TOOLS_STRESS_MEASURE_H
#define TRIM3R_TOOLS_STRESS_MEASURE_H

#include "study/stress/run.h"

/* Fills `rows` (stress_row_count()), except values that need another cell, and the same number of pictures in
 * `renders`. `p` may be NULL. Losses are against all points of the same frames until stress_relate(). Returns an exit
 * status of cli.h; a refusal counts as a result. */
int stress_measure(stress_row *rows, uint8_t *renders, const stress_case *c, const stress_contest *contest,
                   const perturbation *p, uint32_t grade);

/* Fills losses and ratios of `rows` against the unperturbed rows, and marks rows of trim3r as broken whose arena
 * differs. An automatic budget has an arena for all points, which are as many as the views show: it is not marked. */
void stress_relate(stress_row *rows, const stress_row *unperturbed, uint32_t count, bool automatic);

#endif
