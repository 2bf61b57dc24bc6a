/* SPDX-License-Identifier: Apache-2.0 */
/* A complete evaluation: cases, rows, outputs. */
#ifndef TRIM3R_TOOLS_EVALUATION_RUN_H
#define TRIM3R_TOOLS_EVALUATION_RUN_H

#include "evaluation/options.h"

/* Measures the contestants on every case at every budget of the options. Returns an exit status of cli.h. */
int evaluation_run(const evaluation_options *options, const evaluation_contestants *contestants);

#endif
