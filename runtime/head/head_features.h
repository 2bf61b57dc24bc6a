/* SPDX-License-Identifier: Apache-2.0 */
/* The input of a learned head: T3R_FEATURES int8 channels a pixel of the working size (SPEC.md, "Head features").
 *
 *   0..2  red, green, blue - 128
 *   3     retained: 127 or 0
 *   4     measured 127, filled 64, none 0
 *   5     log2 of the density of retained points, Q4, + 64: spacing 2^(-density / 2)
 *   6     log2 of the blurred texture (floor added as in the budget), Q3 centred: (log2(texture_q4 + 8) - 9.5) x 16
 *   7, 8  gradient of depth along x and y over depth, central difference, x 4064, held within +-127: 16 is a surface
 *         at 45 degrees seen with f = 256 px; 0 where a neighbour has no depth
 *
 * Channels 4..8 are 0, -70, 0, 0, 0 where a pixel has no depth, and where it was deferred (budget.h) and not retained.
 * Unadapted (head.h), every pixel with a depth counts as retained at density 1, and none as deferred.
 * Channels lie together: row[x][channel]. */
#ifndef T3R_HEAD_FEATURES_H
#define T3R_HEAD_FEATURES_H

#include <stdint.h>

#include "head.h"
#include "weights.h"

/* Compute the features of one pixel, and of one row of the view: width x T3R_FEATURES. */
void t3r_head_features_at(const t3r_head_input *input, uint32_t x, uint32_t y, int8_t features[T3R_FEATURES]);
void t3r_head_features(const t3r_head_input *input, uint32_t y, int8_t *row);

#endif
