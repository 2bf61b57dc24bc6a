/* SPDX-License-Identifier: Apache-2.0 */
/* Halves of 64-bit numbers, and tables of pairs, for lanes that alternate (even_odd.h) without mask registers to join
 * them. */
#ifndef T3R_KERNELS_LANES_ALTERNATING_H
#define T3R_KERNELS_LANES_ALTERNATING_H

/* Joins even lanes of one and odd lanes of the other. */
static inline T3R_LANES_TARGET lanes alternating(lanes even, lanes odd);

/* Return the low and the high halves of 64 bits. */
static inline T3R_LANES_TARGET lanes low_of(wide x)
{
    return alternating(x.even, OF_LANES(slli_epi64)(x.odd, 32));
}

static inline T3R_LANES_TARGET lanes high_of(wide x)
{
    return alternating(odd_of(x.even), x.odd);
}

/* Loads two neighbours in the table. */
static inline T3R_LANES_TARGET quad pair_at(const uint32_t *table, const uint32_t *index)
{
    return load_half_quad(&table[*index]);
}

/* Joins parts of 128 bits to a vector. */
static inline T3R_LANES_TARGET lanes joined(const quad x[LANES / 4]);

/* Loads pairs for every other entry. */
static inline T3R_LANES_TARGET lanes pairs_at(const uint32_t *table, const uint32_t *index)
{
    quad x[LANES / 4];
    for (int i = 0; i < LANES / 4; i++) {
        x[i] = OF_QUAD(unpacklo_epi64)(pair_at(table, index + 4 * i), pair_at(table, index + 4 * i + 2));
    }
    return joined(x);
}

/* Looks up entries 0..127 of a table of 129, and the next ones. Single loads take no more time than a gather. */
static inline T3R_LANES_TARGET void look_up(const uint32_t *table, lanes index, lanes *entry, lanes *next)
{
    uint32_t at[LANES];
    store(at, index);
    const wide pair = {pairs_at(table, at), pairs_at(table, at + 1)};
    *entry = low_of(pair);
    *next = high_of(pair);
}

#endif
