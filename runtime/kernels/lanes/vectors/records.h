/* SPDX-License-Identifier: Apache-2.0 */
/* Reads and writes words of LANES records, one vector per word. Included after a header of lanes. */
#ifndef T3R_KERNELS_LANES_RECORDS_H
#define T3R_KERNELS_LANES_RECORDS_H

#include <stddef.h>

/* Transposes 4 x 4 words in each 128 bits. */
static inline T3R_LANES_TARGET void transpose(lanes v[4])
{
    const lanes a = OF_LANES(unpacklo_epi32)(v[0], v[1]), b = OF_LANES(unpackhi_epi32)(v[0], v[1]);
    const lanes c = OF_LANES(unpacklo_epi32)(v[2], v[3]), d = OF_LANES(unpackhi_epi32)(v[2], v[3]);
    v[0] = OF_LANES(unpacklo_epi64)(a, c);
    v[1] = OF_LANES(unpackhi_epi64)(a, c);
    v[2] = OF_LANES(unpacklo_epi64)(b, d);
    v[3] = OF_LANES(unpackhi_epi64)(b, d);
}

/* Reads words 0..3 at from[0], from[1]... */
static inline T3R_LANES_TARGET void read_four(const uint8_t *const from[LANES], size_t at, lanes word[4])
{
    T3R_LANES_UNROLL for (int i = 0; i < 4; i++)
    {
        quad x[LANES / 4];
        T3R_LANES_UNROLL for (int k = 0; k < LANES / 4; k++)
        {
            x[k] = load_quad(from[i + 4 * k] + at);
        }
        word[i] = joined(x);
    }
    transpose(word);
}

static inline T3R_LANES_TARGET void read_two(const uint8_t *const from[LANES], size_t at, lanes word[2])
{
    lanes two[4];
    T3R_LANES_UNROLL for (int i = 0; i < 4; i++)
    {
        quad x[LANES / 4];
        T3R_LANES_UNROLL for (int k = 0; k < LANES / 4; k++)
        {
            x[k] = load_half_quad(from[i + 4 * k] + at);
        }
        two[i] = joined(x);
    }
    const lanes a = OF_LANES(unpacklo_epi32)(two[0], two[1]), b = OF_LANES(unpacklo_epi32)(two[2], two[3]);
    word[0] = OF_LANES(unpacklo_epi64)(a, b);
    word[1] = OF_LANES(unpackhi_epi64)(a, b);
}

static inline T3R_LANES_TARGET void write_four(const lanes word[4], uint8_t *const to[LANES], size_t at)
{
    lanes row[4] = {word[0], word[1], word[2], word[3]};
    transpose(row);
    T3R_LANES_UNROLL for (int i = 0; i < 4; i++)
    {
        T3R_LANES_UNROLL for (int k = 0; k < LANES / 4; k++)
        {
            store_quad(to[i + 4 * k] + at, part(row[i], k));
        }
    }
}

static inline T3R_LANES_TARGET void write_two(const lanes word[2], uint8_t *const to[LANES], size_t at)
{
    const lanes two[2] = {OF_LANES(unpacklo_epi32)(word[0], word[1]), OF_LANES(unpackhi_epi32)(word[0], word[1])};
    T3R_LANES_UNROLL for (int i = 0; i < 4; i += 2)
    {
        T3R_LANES_UNROLL for (int k = 0; k < LANES / 4; k++)
        {
            const quad pair = part(two[i / 2], k);
            store_half_quad(to[i + 4 * k] + at, pair);
            store_half_quad(to[i + 1 + 4 * k] + at, OF_QUAD(unpackhi_epi64)(pair, pair));
        }
    }
}

#endif
