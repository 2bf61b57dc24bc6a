#include "census.h"

#include "core/fixed.h"

/* One comparison more in every byte: bits = 2 bits + (a > b). */
static void compare(const uint8_t *a, const uint8_t *b, uint32_t count, uint8_t *restrict bits)
{
    for (uint32_t x = 0; x < count; x++) {
        bits[x] = (uint8_t)(bits[x] + bits[x] + (a[x] > b[x]));
    }
}

/* Which places are compared, columns and rows from the pixel: 17 opposite pairs of 7 x 5, which noise moves least, and
 * the pixel itself with seven others, which shows where edges are. */
static const struct {
    int8_t ax, ay, bx, by;
} pairs[T3R_CENSUS_PAIRS] = {
    {1, 0, -1, 0},  {2, 0, -2, 0},  {3, 0, -3, 0},  {-3, 1, 3, -1}, {-2, 1, 2, -1}, {-1, 1, 1, -1},
    {0, 1, 0, -1},  {1, 1, -1, -1}, {2, 1, -2, -1}, {3, 1, -3, -1}, {-3, 2, 3, -2}, {-2, 2, 2, -2},
    {-1, 2, 1, -2}, {0, 2, 0, -2},  {1, 2, -1, -2}, {2, 2, -2, -2}, {3, 2, -3, -2}, {1, 0, 0, 0},
    {-1, 0, 0, 0},  {0, 1, 0, 0},   {0, -1, 0, 0},  {2, 0, 0, 0},   {-2, 0, 0, 0},  {0, 2, 0, 0},
};

static uint8_t held(const uint8_t *row, int32_t x, int32_t width)
{
    return row[t3r_clamp32(x, 0, width - 1)];
}

static void compare_ends(const uint8_t *a, const uint8_t *b, int32_t ax, int32_t bx, int32_t from, int32_t to,
                         int32_t width, uint8_t *bits)
{
    for (int32_t x = from; x < to; x++) {
        bits[x] = (uint8_t)(bits[x] + bits[x] + (held(a, x + ax, width) > held(b, x + bx, width)));
    }
}

void t3r_census_row_c(const uint8_t *const rows[T3R_CENSUS_ROWS], uint32_t width, uint32_t pitch, uint8_t *bits)
{
    const int32_t middle = T3R_CENSUS_ROWS / 2, last = (int32_t)width;
    const int32_t from = T3R_MIN(T3R_CENSUS_REACH, last), to = T3R_MAX(from, last - T3R_CENSUS_REACH);
    for (uint32_t i = 0; i < T3R_CENSUS_BYTES; i++) {
        for (uint32_t x = 0; x < width; x++) {
            bits[i * pitch + x] = 0;
        }
    }
    for (uint32_t i = 0; i < T3R_CENSUS_PAIRS; i++) {
        const uint8_t *a = rows[middle + pairs[i].ay], *b = rows[middle + pairs[i].by];
        const int32_t ax = pairs[i].ax, bx = pairs[i].bx;
        uint8_t *out = bits + i / 8 * pitch;
        compare_ends(a, b, ax, bx, 0, from, last, out);
        compare(a + from + ax, b + from + bx, (uint32_t)(to - from), out + from); /* in the middle nothing is held */
        compare_ends(a, b, ax, bx, to, last, last, out);
    }
}

/* Set bits of each nibble of x: 0..4 each */
static inline uint8_t nibble_counts(uint8_t x)
{
    x = (uint8_t)(x - ((x >> 1) & 0x55));
    return (uint8_t)((x & 0x33) + ((x >> 2) & 0x33));
}

void t3r_census_cost_c(const uint8_t own[T3R_CENSUS_BYTES], const uint8_t *others, uint32_t pitch, const uint8_t *least,
                       uint32_t count, uint8_t *restrict cost)
{
    const uint8_t a = own[0], b = own[1], c = own[2];
    const uint8_t *p = others, *q = p + pitch, *r = q + pitch;
    count &= ~15u;
    for (size_t k = 0; k < count; k++) {
        /* each nibble at most 3 x 4 */
        uint8_t nibbles = (uint8_t)(nibble_counts(a ^ p[k]) + nibble_counts(b ^ q[k]) + nibble_counts(c ^ r[k]));
        uint8_t sum = (uint8_t)((nibbles & 15) + (nibbles >> 4));
        cost[k] = sum > least[k] ? sum : least[k];
    }
}
