/* SPDX-License-Identifier: Apache-2.0 */
/* Logarithms by the table of core/fixed_tables.h. Included after a header of lanes. */
#ifndef T3R_KERNELS_LANES_LOGARITHM_LANES_H
#define T3R_KERNELS_LANES_LOGARITHM_LANES_H

#include "core/fixed_tables.h"

/* Interpolates between an entry of the table and the next. */
static inline T3R_LANES_TARGET lanes interpolated(const uint32_t *table, lanes index, lanes fraction_q16)
{
    lanes entry, next;
    look_up(table, index, &entry, &next);
    const lanes step = subtract(next, entry);
    return add(entry, OF_LANES(srli_epi32)(add(multiply(step, fraction_q16), all(0x8000)), 16));
}

/* Returns the logarithm's fraction, Q16, of numbers whose highest bit is bit 30. */
static inline T3R_LANES_TARGET lanes log_fraction_q16(lanes normal)
{
    const lanes index = both(OF_LANES(srli_epi32)(normal, 23), all(127));
    const lanes fraction_q16 = both(OF_LANES(srli_epi32)(normal, 7), all(0xffff));
    const lanes log_q20 = interpolated(t3r_log2_table_q20, index, fraction_q16);
    return OF_LANES(srli_epi32)(add(log_q20, all(8)), 4);
}

/* Returns t3r_log2_q16(), x in 2^(31 - 2 first_step)..2^31 - 1. */
static inline T3R_LANES_TARGET lanes log_q16(lanes x, int first_step)
{
    lanes by;
    const lanes normal = normal_of(x, first_step, &by);
    return add(OF_LANES(slli_epi32)(subtract(all(30), by), 16), log_fraction_q16(normal));
}

#endif
