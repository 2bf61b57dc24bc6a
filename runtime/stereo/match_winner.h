/* The disparities of one row from its summed costs. */
#ifndef T3R_MATCH_WINNER_H
#define T3R_MATCH_WINNER_H

#include <stdint.h>

#include "match.h"

/* Chooses the disparities of row y. sums: width x disparities; work: twice T3R_MATCH_RIGHT(width, disparities)
 * int16. */
void t3r_match_winners(const t3r_match *match, uint32_t y, const int16_t *sums, int16_t *work);

#endif
