/* What two views say of one surface, compared: the error that no number of Gaussians takes away. */
#ifndef T3R_DISAGREEMENT_H
#define T3R_DISAGREEMENT_H

#include <stdint.h>

#include "state/views.h"

/* Mean squared difference of levelled colours a channel, levels^2 Q8, at most 2^24, over the pixels not doubtful that
 * were measured and fall on such a one in the next or the previous view, the last and the first being next to each
 * other, at a depth at most 1/32 off. *pairs, below 2^29: how many they are; 0 of none. */
uint32_t t3r_disagreement_q8(const t3r_view *views, uint32_t count, int32_t exponent, uint16_t gain_q14[][3],
                             uint32_t *pairs);

#endif
