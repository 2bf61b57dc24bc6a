/* SPDX-License-Identifier: Apache-2.0 */
/* census_costs in vectors of BYTES disparities; included after path_lanes.h's declarations. */
#ifndef T3R_CENSUS_LANES_H
#define T3R_CENSUS_LANES_H

/* Returns table[x] of each lane, x 0..15. */
static inline TARGET bytes look_up(const uint8_t table[16], bytes x);

static inline TARGET bytes larger(bytes a, bytes b)
{
    return (bytes)OF(max_epu8)((vector)a, (vector)b);
}

/* Shifts 16-bit lanes down by 4. */
static inline TARGET bytes fourth(bytes x)
{
    return (bytes)OF(srli_epi16)((vector)x, 4);
}

static const uint8_t ones[16] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};
static const uint8_t twice_ones[16] = {0, 2, 2, 4, 2, 4, 4, 6, 2, 4, 4, 6, 4, 6, 6, 8};

static inline TARGET bytes count_ones(const uint8_t table[16], bytes x)
{
    const bytes low = all_of(15);
    return look_up(table, x & low) + look_up(table, fourth(x) & low);
}

/* Counts set bits of three bytes by a full adder: bits of the sum once, bits of the carry twice. */
static inline TARGET bytes differences(bytes a, bytes b, bytes c)
{
    const bytes odd = a ^ b;
    return count_ones(ones, odd ^ c) + count_ones(twice_ones, (a & b) | (odd & c));
}

/* Compiles t3r_census_mirror() for vectors. */
static inline TARGET void mirror(const t3r_census_costs *row)
{
    t3r_census_mirror(row);
}

/* count: the number of disparities, as a constant */
static inline __attribute__((always_inline)) TARGET void costs(const t3r_census_costs *given, const uint32_t count)
{
    const t3r_census_costs all = *given, *row = &all; /* a copy, which byte writes cannot change */
    const size_t width = row->width, right = T3R_MATCH_RIGHT(width, count);
    for (size_t x = 0; x < width; x++) {
        const bytes a = all_of(row->bits[x]), b = all_of(row->bits[width + x]), c = all_of(row->bits[2 * width + x]);
        const bytes shown = all_of(row->luma[x] != 0 ? UINT8_MAX : 0);
        for (uint32_t k = 0; k < count; k += BYTES) {
            const uint8_t *other = row->mirrored + (width - 1 - x) + k;
            const bytes sum = differences(a ^ load(other, count - k), b ^ load(other + right, count - k),
                                          c ^ load(other + 2 * right, count - k));
            const bytes least = load(row->least + (width - 1 - x) + k, count - k);
            store(row->cost + x * count + k, larger(sum, least) & shown, count - k);
        }
    }
}

#endif
