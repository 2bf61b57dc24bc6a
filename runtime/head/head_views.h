/* SPDX-License-Identifier: Apache-2.0 */
/* The configured head over the retained points of views: bands of rows, shared out among workers. */
#ifndef T3R_HEAD_VIEWS_H
#define T3R_HEAD_VIEWS_H

#include "head.h"
#include "state/state.h"

/* What the head sees of a view, its work being worker 0's. It holds the pointers that it is given. */
t3r_head_input t3r_head_input_of(const t3r_runtime *rt, const t3r_view *views, uint32_t view_index,
                                 const t3r_budget_settings *settings);

/* Writes the Gaussians of all views to `out`, in the order of views and rows, their colours brought to the mean
 * exposure; *made: how many. T3R_OK or T3R_ERR_CANCELLED. */
t3r_status t3r_views_to_gaussians(const t3r_runtime *rt, const t3r_view *views, const t3r_budget_settings *settings,
                                  t3r_gaussian *out, uint32_t *made);

/* The same of one view, without a call of progress; returns how many. */
uint32_t t3r_view_to_gaussians(const t3r_runtime *rt, const t3r_view *views, uint32_t view_index,
                               const t3r_budget_settings *settings, t3r_gaussian *out);

#endif
