/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures at 4/5, 16/25 ... of their size. */
#ifndef TRIM3R_TOOLS_POSING_PYRAMID_H
#define TRIM3R_TOOLS_POSING_PYRAMID_H

#include <stdint.h>

/* A side one level up: 4/5 of it, rounded down. */
uint32_t pyramid_side(uint32_t side);

/* The exact area average of width x height grey pixels over pyramid_side() of them each way, rounded half up. Rows
 * without gaps; different memory; sides 2..4096. */
void pyramid_reduce(const uint8_t *grey, uint32_t width, uint32_t height, uint8_t *out);

#endif
