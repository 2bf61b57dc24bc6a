/* SPDX-License-Identifier: Apache-2.0 */
/* Runs the configured head over the retained points of views, in bands of rows shared among workers. */
#ifndef T3R_HEAD_VIEWS_H
#define T3R_HEAD_VIEWS_H

#include "head.h"
#include "state/state.h"

/* Returns the head's input for a view, with worker 0's work. It keeps the given pointers. */
t3r_head_input t3r_head_input_of(const t3r_runtime *rt, const t3r_view *views, uint32_t view_index,
                                 const t3r_budget_settings *settings);

/* Writes the Gaussians of all views to `out`, in the order of views and rows, with colours scaled to the mean
 * exposure; *made: their number. T3R_OK or T3R_ERR_CANCELLED. */
t3r_status t3r_views_to_gaussians(const t3r_runtime *rt, const t3r_view *views, const t3r_budget_settings *settings,
                                  t3r_gaussian *out, uint32_t *made);

/* Writes the Gaussians of one view without reporting progress; returns their number. */
uint32_t t3r_view_to_gaussians(const t3r_runtime *rt, const t3r_view *views, uint32_t view_index,
                               const t3r_budget_settings *settings, t3r_gaussian *out);

#endif
