#include "census.h"

#include "fixed.h"

/* One comparison more in every byte: bits = 2 bits + (a > b). */
static void compare(const uint8_t *a, const uint8_t *b, uint32_t count, uint8_t *restrict bits)
{
    for (uint32_t x = 0; x < count; x++) {
        bits[x] = (uint8_t)(bits[x] + bits[x] + (a[x] > b[x]));
    }
}

static uint8_t held(const uint8_t *row, int32_t x, int32_t width)
{
    return row[t3r_clamp32(x, 0, width - 1)];
}

void t3r_census_row(const uint8_t *const rows[T3R_CENSUS_ROWS], uint32_t width, uint32_t pitch, uint8_t *bits)
{
    const int32_t middle = T3R_CENSUS_ROWS / 2, reach = T3R_CENSUS_REACH, last = (int32_t)width;
    for (uint32_t i = 0; i < T3R_CENSUS_BYTES; i++) {
        for (uint32_t x = 0; x < width; x++) {
            bits[i * pitch + x] = 0;
        }
    }
    uint32_t pair = 0;
    for (int32_t dy = 0; dy <= middle; dy++) {
        for (int32_t dx = dy == 0 ? 1 : -reach; dx <= reach; dx++, pair++) {
            const uint8_t *a = rows[middle + dy], *b = rows[middle - dy];
            uint8_t *out = bits + pair / 8 * pitch;
            int32_t from = T3R_MIN(reach, last), to = T3R_MAX(from, last - reach); /* between them nothing is held */
            for (int32_t x = 0; x < from; x++) {
                out[x] = (uint8_t)(out[x] + out[x] + (held(a, x + dx, last) > held(b, x - dx, last)));
            }
            compare(a + from + dx, b + from - dx, (uint32_t)(to - from), out + from);
            for (int32_t x = to; x < last; x++) {
                out[x] = (uint8_t)(out[x] + out[x] + (held(a, x + dx, last) > held(b, x - dx, last)));
            }
        }
    }
}

/* Set bits of each nibble of x: 0..4 each */
static inline uint8_t nibble_counts(uint8_t x)
{
    x = (uint8_t)(x - ((x >> 1) & 0x55));
    return (uint8_t)((x & 0x33) + ((x >> 2) & 0x33));
}

void t3r_census_cost(const uint8_t own[T3R_CENSUS_BYTES], const uint8_t *others, uint32_t pitch, const uint8_t *least,
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
