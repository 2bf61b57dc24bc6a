/* SPDX-License-Identifier: Apache-2.0 */
/* Finds the ranges of a float head's activations by running it on the runtime's input. */
#ifndef T3R_QUANT_CALIBRATE_H
#define T3R_QUANT_CALIBRATE_H

#include "float_head.h"
#include "float_run.h"
#include "trim3r.h"

typedef struct calibration calibration;

/* Starts a calibration. The head must outlive it. Returns NULL without memory; calibration_free() takes NULL. */
calibration *calibration_start(const float_head *head);
void calibration_free(calibration *c);

/* Adds one view's features and retained pixels (float_run.h). Returns 0, or -1 without memory. */
int calibration_add(calibration *c, const int8_t *features, const uint8_t *retained, uint32_t width, uint32_t height);
/* Adds every context view of a runtime that holds a scene and its analysis (keep_analysis), with the last budget's
 * mask. Returns 0, or -1 without either or without memory. */
int calibration_add_views(calibration *c, const t3r_runtime *runtime);

/* Returns the number of pixels added so far, over all views and budgets. */
uint64_t calibration_pixels(const calibration *c);

/* Sets the missing ranges of every layer of `head` except the last, whose formats are fixed: the `percentile` (0..100]
 * of a channel's values, found to 1/64, times `headroom`; for a linear layer, of their magnitudes. 100 is the exact
 * maximum. A channel that was always 0 gets the largest range of its layer. Returns the number of layers whose ranges
 * were missing; -1 without memory, or without a pixel if one was needed. */
int calibration_finish(const calibration *c, float_head *head, double percentile, double headroom);

#endif
