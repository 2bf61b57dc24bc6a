/* A threshold map whose low ranks are spread evenly: keep the pixels below a density, and they are (SPEC, "Budget"). */
#ifndef T3R_BLUE_NOISE_H
#define T3R_BLUE_NOISE_H

#include <stdint.h>

#define T3R_BLUE_NOISE_SIDE 64

/* Ranks 0..4095, row-major, periodic. */
extern const uint16_t t3r_blue_noise[T3R_BLUE_NOISE_SIDE * T3R_BLUE_NOISE_SIDE];

#endif
