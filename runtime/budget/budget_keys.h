/* SPDX-License-Identifier: Apache-2.0 */
/* Keys: log2 of a point's blue-noise threshold over the density wanted around it. */
#ifndef T3R_BUDGET_KEYS_H
#define T3R_BUDGET_KEYS_H

#include "budget.h"

/* Computes the keys of all pixels, of which t3r_allocate() retains the smallest: T3R_KEY_ZERO + log2 of the threshold
 * - wanted, except for sure and deferred points. */
void t3r_budget_keys(const t3r_view *views, uint32_t count, const t3r_budget_settings *settings,
                     const t3r_budget_work *work);

/* Compute log2 of the density that a texture asks for, up to a constant, Q10: gamma log2(texture + floor), at most 32;
 * for one pixel, and for a run of at most T3R_KEY_RUN. */
int32_t t3r_log_wanted_q10(uint16_t texture_q4, const t3r_budget_settings *settings);
void t3r_find_wanted(const t3r_budget_settings *settings, const t3r_kernels *kernels, const uint16_t *texture_q4,
                     uint32_t count, uint16_t *wanted_q10);

#endif
