/* What instruction sets without mask registers share: a mask has all bits of a lane, or none. Comes behind
 * lanes_operations.h. */
#ifndef T3R_KERNELS_LANES_MASKS_H
#define T3R_KERNELS_LANES_MASKS_H

/* Even lanes of one, odd ones of the other. */
static inline T3R_LANES_TARGET lanes alternating(lanes even, lanes odd);

/* All bits where a is greater, or equal; else none. */
static inline T3R_LANES_TARGET lanes greater(lanes a, lanes b)
{
    return OF_LANES(cmpgt_epi32)(a, b);
}

static inline T3R_LANES_TARGET lanes equal(lanes a, lanes b)
{
    return OF_LANES(cmpeq_epi32)(a, b);
}

/* a >= b, of unsigned numbers */
static inline T3R_LANES_TARGET lanes at_least(lanes a, lanes b)
{
    return equal(OF_LANES(max_epu32)(a, b), a);
}

/* b where the mask has all bits, else a */
static inline T3R_LANES_TARGET lanes chosen(lanes mask, lanes b, lanes a)
{
    return OF_LANES(blendv_epi8)(a, b, mask);
}

/* The low and the high halves of 64 bits. */
static inline T3R_LANES_TARGET lanes low_of(wide x)
{
    return alternating(x.even, OF_LANES(slli_epi64)(x.odd, 32));
}

static inline T3R_LANES_TARGET lanes high_of(wide x)
{
    return alternating(odd_of(x.even), x.odd);
}

/* Two neighbours in the table. */
static inline T3R_LANES_TARGET quad pair_at(const uint32_t *table, const uint32_t *index)
{
    return load_half_quad(&table[*index]);
}

/* A vector of parts of 128 bits. */
static inline T3R_LANES_TARGET lanes joined(const quad x[LANES / 4]);

/* Pairs of every other entry. */
static inline T3R_LANES_TARGET lanes pairs_at(const uint32_t *table, const uint32_t *index)
{
    quad x[LANES / 4];
    for (int i = 0; i < LANES / 4; i++) {
        x[i] = OF_QUAD(unpacklo_epi64)(pair_at(table, index + 4 * i), pair_at(table, index + 4 * i + 2));
    }
    return joined(x);
}

/* Entries 0..127 of a table of 129, and those after them. Loads one by one take no more time than a gather. */
static inline T3R_LANES_TARGET void look_up(const uint32_t *table, lanes index, lanes *entry, lanes *next)
{
    uint32_t at[LANES];
    store(at, index);
    const wide pair = {pairs_at(table, at), pairs_at(table, at + 1)};
    *entry = low_of(pair);
    *next = high_of(pair);
}

#endif
