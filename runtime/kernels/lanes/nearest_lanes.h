/* SPDX-License-Identifier: Apache-2.0 */
/* The nearest centre by comparing all of them, LANES at a time. Included after a header of lanes, in a file that names
 * the functions NEAREST_BEGIN and NEAREST. */
#ifndef T3R_KERNELS_LANES_NEAREST_LANES_H
#define T3R_KERNELS_LANES_NEAREST_LANES_H

#include "packed_centres.h"

T3R_LANES_TARGET void NEAREST_BEGIN(const t3r_centres *centres, uint32_t first, uint32_t end,
                                    const t3r_neighbours *neighbours)
{
    for (uint32_t group = first; group < end; group += T3R_CENTRE_GROUP) {
        t3r_packed_group *packed = t3r_packed_group_of(neighbours, group);
        for (uint32_t i = 0; i < T3R_CENTRE_GROUP; i++) {
            const uint32_t k = group + i;
            const bool is_centre = k < centres->count;
            for (uint32_t d = 0; d < T3R_PAIRS; d++) {
                const int16_t two[2] = {is_centre ? centres->feature_q11[2 * d][k] : 0,
                                        is_centre ? centres->feature_q11[2 * d + 1][k] : 0};
                packed->pair[d][i] = t3r_pair_of(two, 0);
            }
            packed->half_norm[i] = is_centre ? centres->half_norm[k] : INT32_MAX; /* larger than any centre's score */
        }
    }
}

/* Not `lanes`: if the least so far changes its type, gcc 12 copies it in every iteration. */
typedef int32_t ints __attribute__((vector_size(LANES * sizeof(int32_t))));

/* A point; in each lane the least score so far, and the first centre of the vector in which the lane had it. */
typedef struct search {
    lanes pair[T3R_PAIRS];
    ints least, first;
} search;

static T3R_LANES_TARGET search search_of(const int16_t p[T3R_DIMENSIONS])
{
    search s = {.least = (ints)all(INT32_MAX), .first = (ints)all(0)};
    for (uint32_t d = 0; d < T3R_PAIRS; d++) {
        s.pair[d] = all(t3r_pair_of(p, d));
    }
    return s;
}

/* Scores and their parts are below 2^31 in size: |p c| is at most 6 x 15000^2. A lane keeps the earlier of equals. */
static inline T3R_LANES_TARGET void look(search *s, const lanes pair[T3R_PAIRS], lanes half_norm, lanes here)
{
    const ints score = (ints)half_norm - (ints)OF_LANES(madd_epi16)(s->pair[0], pair[0]) -
                       (ints)OF_LANES(madd_epi16)(s->pair[1], pair[1]) -
                       (ints)OF_LANES(madd_epi16)(s->pair[2], pair[2]);
    const lanes less = greater((lanes)s->least, (lanes)score);
    s->least = (ints)OF_LANES(min_epi32)((lanes)s->least, (lanes)score);
    s->first = (ints)chosen(less, here, (lanes)s->first);
}

/* Returns the least number of a vector. */
static inline T3R_LANES_TARGET int32_t least_of(lanes x)
{
    quad least = part(x, 0);
    for (int i = 1; i < LANES / 4; i++) {
        least = OF_QUAD(min_epi32)(least, part(x, i));
    }
    return least_of_quad(least);
}

/* Returns the least index with the least score. */
static inline T3R_LANES_TARGET uint16_t nearest_of(const search *s)
{
    static const int32_t numbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    const lanes index = add((lanes)s->first, load(numbers));
    const lanes has_it = equal((lanes)s->least, all(least_of((lanes)s->least)));
    return (uint16_t)least_of(chosen(has_it, index, all(INT32_MAX)));
}

T3R_LANES_TARGET void NEAREST(const t3r_centres *centres, const t3r_neighbours *neighbours, uint32_t points,
                              const int16_t (*feature_q11)[T3R_DIMENSIONS], uint16_t guess, uint16_t *nearest)
{
    (void)guess;
    for (uint32_t point = 0; point < points; point += 2) { /* two share the loads; pads by repeating the last */
        const uint32_t other = point + 1 < points ? point + 1 : point;
        search a = search_of(feature_q11[point]), b = search_of(feature_q11[other]);
        for (uint32_t group = 0; group < centres->count; group += T3R_CENTRE_GROUP) {
            const t3r_packed_group *packed = t3r_packed_group_of(neighbours, group);
            for (uint32_t i = 0; i < T3R_CENTRE_GROUP; i += LANES) {
                lanes pair[T3R_PAIRS];
                for (uint32_t d = 0; d < T3R_PAIRS; d++) {
                    pair[d] = load(&packed->pair[d][i]);
                }
                const lanes half_norm = load(&packed->half_norm[i]);
                const lanes here = all((int32_t)(group + i));
                look(&a, pair, half_norm, here);
                look(&b, pair, half_norm, here);
            }
        }
        nearest[point] = nearest_of(&a);
        nearest[other] = nearest_of(&b);
    }
}

#endif
