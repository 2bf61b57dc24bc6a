#include "kernels/census.h"

#include "core/fixed.h"

/* The places compared, columns and rows from the pixel: 17 opposite pairs of 7 x 5, which noise changes least, and the
 * pixel itself with seven others, which separates edges. */
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

/* Computes the bits of eight pairs in the middle of a row, where no column is clamped. a, b: the places of the first
 * pixel's pairs. */
static void compare_eight(const uint8_t *const a[8], const uint8_t *const b[8], uint32_t count, uint8_t *restrict bits)
{
    const uint8_t *a0 = a[0], *a1 = a[1], *a2 = a[2], *a3 = a[3], *a4 = a[4], *a5 = a[5], *a6 = a[6], *a7 = a[7];
    const uint8_t *b0 = b[0], *b1 = b[1], *b2 = b[2], *b3 = b[3], *b4 = b[4], *b5 = b[5], *b6 = b[6], *b7 = b[7];
    for (uint32_t x = 0; x < count; x++) {
        uint8_t all = (uint8_t)(a0[x] > b0[x] ? 128 : 0);
        all |= (uint8_t)(a1[x] > b1[x] ? 64 : 0);
        all |= (uint8_t)(a2[x] > b2[x] ? 32 : 0);
        all |= (uint8_t)(a3[x] > b3[x] ? 16 : 0);
        all |= (uint8_t)(a4[x] > b4[x] ? 8 : 0);
        all |= (uint8_t)(a5[x] > b5[x] ? 4 : 0);
        all |= (uint8_t)(a6[x] > b6[x] ? 2 : 0);
        bits[x] = (uint8_t)(all | (uint8_t)(a7[x] > b7[x] ? 1 : 0));
    }
}

void t3r_census_row_c(const uint8_t *const rows[T3R_CENSUS_ROWS], uint32_t width, uint32_t pitch, uint8_t *bits)
{
    const int32_t middle = T3R_CENSUS_ROWS / 2, last = (int32_t)width;
    const int32_t from = T3R_MIN(T3R_CENSUS_REACH, last), to = T3R_MAX(from, last - T3R_CENSUS_REACH);
    for (uint32_t byte = 0; byte < T3R_CENSUS_BYTES; byte++) {
        uint8_t *out = bits + byte * pitch;
        const uint8_t *a[8], *b[8];
        for (int32_t x = 0; x < from; x++) {
            out[x] = 0;
        }
        for (int32_t x = to; x < last; x++) {
            out[x] = 0;
        }
        for (uint32_t i = 0; i < 8; i++) {
            const int32_t ax = pairs[8 * byte + i].ax, bx = pairs[8 * byte + i].bx;
            const uint8_t *first = rows[middle + pairs[8 * byte + i].ay];
            const uint8_t *second = rows[middle + pairs[8 * byte + i].by];
            compare_ends(first, second, ax, bx, 0, from, last, out);
            compare_ends(first, second, ax, bx, to, last, last, out);
            a[i] = to > from ? first + from + ax : first;
            b[i] = to > from ? second + from + bx : second;
        }
        compare_eight(a, b, (uint32_t)(to - from), out + from);
    }
}
