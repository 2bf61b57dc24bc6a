#include "kernels/census.h"

/* Returns the set bits of each nibble of x: 0..4 each. */
static inline uint8_t nibble_counts(uint8_t x)
{
    x = (uint8_t)(x - ((x >> 1) & 0x55));
    return (uint8_t)((x & 0x33) + ((x >> 2) & 0x33));
}

static void cost_of(const uint8_t own[T3R_CENSUS_BYTES], const uint8_t *others, size_t pitch, const uint8_t *least,
                    size_t count, uint8_t *restrict cost)
{
    const uint8_t a = own[0], b = own[1], c = own[2];
    const uint8_t *p = others, *q = p + pitch, *r = q + pitch;
    for (size_t k = 0; k < count; k++) {
        /* each nibble at most 3 x 4 */
        uint8_t nibbles = (uint8_t)(nibble_counts(a ^ p[k]) + nibble_counts(b ^ q[k]) + nibble_counts(c ^ r[k]));
        uint8_t sum = (uint8_t)((nibbles & 15) + (nibbles >> 4));
        cost[k] = sum > least[k] ? sum : least[k];
    }
}

void t3r_census_costs_c(const t3r_census_costs *row)
{
    const size_t width = row->width, count = row->disparities & ~15u; /* unchanged; shows compilers a multiple of 16 */
    const size_t right = T3R_MATCH_RIGHT(width, count);
    t3r_census_mirror(row);
    for (size_t x = 0; x < width; x++) {
        const uint8_t own[T3R_CENSUS_BYTES] = {row->bits[x], row->bits[width + x], row->bits[2 * width + x]};
        uint8_t *cost = row->cost + x * count;
        if (row->luma[x] != 0) {
            cost_of(own, row->mirrored + (width - 1 - x), right, row->least + (width - 1 - x), count, cost);
        } else {
            for (size_t k = 0; k < count; k++) {
                cost[k] = 0; /* paths pass through a pixel without luma */
            }
        }
    }
}
