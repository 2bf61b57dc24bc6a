/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/live/pass_budget.h"

#include "cli/cli.h"

#define FORGET 0.875

void pass_budget_begin(pass_budget *budget, uint32_t planned)
{
    budget->planned = planned;
    budget->pass = UINT32_MAX; /* none has begun */
    budget->until = cli_now() + budget->most;
}

bool pass_budget_goes_on(pass_budget *budget, uint32_t done, uint32_t total)
{
    const uint32_t pass = (uint32_t)((uint64_t)done * budget->planned / total);
    const double now = cli_now();
    if (pass != budget->pass) {
        budget->pass_seconds = pass > 0 ? now - budget->pass_begun : budget->pass_seconds;
        budget->pass_begun = now;
        budget->pass = pass;
        const bool fits = budget->most <= 0 || now + budget->pass_seconds <= budget->until;
        budget->pass_seconds *= fits ? 1 : FORGET; /* a pass that once took long is tried again */
        return fits;
    }
    return budget->most <= 0 || now <= budget->until;
}
