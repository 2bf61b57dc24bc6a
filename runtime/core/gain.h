/* SPDX-License-Identifier: Apache-2.0 */
/* Gains that level the exposure of views. */
#ifndef T3R_GAIN_H
#define T3R_GAIN_H

#include <stdint.h>

#define T3R_GAIN_ONE_Q14 (1u << 14)

/* Levels a colour of the view by its gain: Q7, clamped to 255. */
static inline uint16_t t3r_level_q7(uint32_t colour_q7, uint16_t gain_q14)
{
    uint32_t levelled = (colour_q7 * gain_q14 + (1u << 13)) >> 14; /* below 2^15 x 2^16 */
    return (uint16_t)(levelled < 255 * 128 ? levelled : 255 * 128);
}

#endif
