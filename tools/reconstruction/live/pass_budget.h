/* SPDX-License-Identifier: Apache-2.0 */
/* Ends the refinement of a keyframe before a pass that would exceed the keyframe's time, by what earlier passes took.
 */
#ifndef TRIM3R_TOOLS_PASS_BUDGET_H
#define TRIM3R_TOOLS_PASS_BUDGET_H

#include <stdbool.h>
#include <stdint.h>

typedef struct pass_budget {
    double most;                     /* seconds from the keyframe's begin to the end of its refinement; 0 = no limit */
    double until;                    /* cli_now() at which this keyframe's time is over */
    uint32_t planned, pass;          /* passes of this keyframe, and the current one */
    double pass_begun, pass_seconds; /* of the current pass, and the length of the last whole one */
} pass_budget;

/* Begins a keyframe of `planned` passes. */
void pass_budget_begin(pass_budget *budget, uint32_t planned);
/* Whether refinement goes on, as the progress hook asks within its stage: a pass begins if the last whole one would
 * have fitted into the time left, and ends when the time is over. */
bool pass_budget_goes_on(pass_budget *budget, uint32_t done, uint32_t total);

#endif
