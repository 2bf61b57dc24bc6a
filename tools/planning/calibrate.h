/* SPDX-License-Identifier: Apache-2.0 */
/* Measures the time of a unit of each kind of work on this machine: times builds of the built-in room stage by stage,
 * and fits prices to the times. */
#ifndef TRIM3R_TOOLS_CALIBRATE_H
#define TRIM3R_TOOLS_CALIBRATE_H

#include "cli/options/processor_options.h"
#include "planning/work.h"

/* Returns CLI_OK, or an exit status of cli.h after a message. `errors` receives for each stage the largest error of its
 * fitted times over the trials, relative to the measured time; NULL = not wanted. */
int calibrate(const processor_options *processor, uint32_t rounds, work_prices *prices, double errors[T3R_STAGE_COUNT]);

#endif
