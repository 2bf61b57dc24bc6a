/* Finds the ranges of a float head's activations by running it on what the runtime sees. */
#ifndef T3R_QUANT_CALIBRATE_H
#define T3R_QUANT_CALIBRATE_H

#include "float_head.h"
#include "float_run.h"
#include "trim3r.h"

typedef struct calibration calibration;

/* The head must outlive the calibration. NULL without memory; calibration_free() takes NULL. */
calibration *calibration_start(const float_head *head);
void calibration_free(calibration *c);

/* Takes in one view's features and retained pixels (float_run.h). 0, or -1 without memory. */
int calibration_add(calibration *c, const int8_t *features, const uint8_t *retained, uint32_t width, uint32_t height);
/* Takes in every context view of a runtime that holds a scene and its analysis (keep_analysis), as its last budget
 * left them. 0, or -1 without either or without memory. */
int calibration_add_views(calibration *c, const t3r_runtime *runtime);

/* Pixels taken in so far, views and budgets together. */
uint64_t calibration_pixels(const calibration *c);

/* Gives every layer of `head` but the last (its formats are fixed) the ranges that it lacks: what `percentile` (0..100]
 * of a channel's values do not exceed, found to 1/64, times `headroom`; of a linear layer their amounts. 100 is the
 * maximum, exactly. A channel that was never anything but 0 gets the largest range of its layer. Returns the number of
 * layers that lacked theirs; -1 without memory, or without a pixel where one was needed. */
int calibration_finish(const calibration *c, float_head *head, double percentile, double headroom);

#endif
