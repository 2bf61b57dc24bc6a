/* SPDX-License-Identifier: Apache-2.0 */
/* Disagreement of views about the colours of one surface: the error that no number of Gaussians removes. */
#ifndef T3R_DISAGREEMENT_H
#define T3R_DISAGREEMENT_H

#include <stdint.h>

#include "state/views.h"

/* Returns the mean squared difference of levelled colours per channel, levels^2 Q8, at most 2^24; 0 without pairs. A
 * pair is two pixels, both measured and not doubtful: one falls on the other in the next or the previous view, at a
 * depth at most 1/32 off. The last view and the first are neighbours. Only every step-th pixel of every step-th row is
 * compared; step >= 1. *pairs: number of pairs, below 2^29.
 *
 * *shared_q8: the mean product of a pair's difference with that of the pair one pixel to the right, per channel, at
 * most 2^24 in size; 0 without such pairs. It is near the disagreement where neighbours differ alike, as by errors of
 * poses, depth or exposure, and near 0 where each pixel differs for itself, as by noise or detail narrower than a
 * pixel. NULL: not measured. */
uint32_t t3r_disagreement_q8(const t3r_view *views, uint32_t count, int32_t exponent, uint16_t gain_q14[][3],
                             uint32_t step, uint32_t *pairs, int32_t *shared_q8);

#endif
