/* SPDX-License-Identifier: Apache-2.0 */
/* ray_row in any number of 32-bit lanes. The including file names the function RAY_ROW and defines TARGET, LANES, the
 * prefix of its instructions (OF) and join(). A quotient x / z is computed from z's reciprocal and corrected by its
 * remainder. */
#ifndef T3R_RAY_LANES_H
#define T3R_RAY_LANES_H

#include <stdbool.h>
#include <stdint.h>

typedef int32_t lanes __attribute__((vector_size(LANES * sizeof(int32_t))));
typedef int32_t lanes_there __attribute__((vector_size(LANES * sizeof(int32_t)), aligned(4), may_alias));
typedef uint32_t ulanes __attribute__((vector_size(LANES * sizeof(int32_t))));
typedef uint64_t pairs __attribute__((vector_size(LANES * sizeof(int32_t))));
typedef long long vector
    __attribute__((vector_size(LANES * sizeof(int32_t)), may_alias)); /* type of the instructions' operands */

/* Joins the even lanes of one and the odd ones of the other. */
static inline TARGET lanes join(pairs even, pairs odd);

/* Multiplies the even lanes. */
static inline TARGET pairs multiply(ulanes a, ulanes b)
{
    return (pairs)OF(mul_epu32)((vector)a, (vector)b);
}

static inline TARGET pairs multiply_signed(lanes a, lanes b)
{
    return (pairs)OF(mul_epi32)((vector)a, (vector)b);
}

/* Largest error of three Newton steps, from rounding below 2^32: the reciprocal is lowered by it, so that it is never
 * too large. */
#define NEWTON_ERROR 3

static inline TARGET pairs odd(lanes x)
{
    return (pairs)x >> 32;
}

static inline TARGET ulanes high(ulanes a, ulanes b)
{
    return (ulanes)join(multiply(a, b) >> 32, multiply((ulanes)odd((lanes)a), (ulanes)odd((lanes)b)));
}

/* Returns a coordinate, below 2^27 in size, for which a logical shift of its 64 bits is enough. sloped: b counts, too.
 */
static inline TARGET lanes coordinate(const t3r_ray_map *map, int axis, lanes a, lanes b, bool sloped)
{
    const uint64_t base = (uint64_t)map->base_q54[axis] + (UINT64_C(1) << 29);
    const lanes turn = (lanes){0} + map->turn_q30[axis], slope = (lanes){0} + map->slope_q30[axis];
    pairs even = multiply_signed(a, turn) + base, uneven = multiply_signed((lanes)odd(a), turn) + base;
    if (sloped) {
        even += multiply_signed(b, slope);
        uneven += multiply_signed((lanes)odd(b), slope);
    }
    return join(even >> 30, uneven << 2);
}

/* Returns 2^58 / d within 2^-27 of itself and never above it, 2^26 <= d < 2^27: three Newton steps, from a line that
 * is within 0.086. */
static inline TARGET ulanes reciprocal(ulanes d)
{
    const ulanes q32 = d << 5; /* 1/2..1; its reciprocal is in Q31 */
    ulanes r = UINT32_C(1963258542) - q32;
    for (int step = 0; step < 3; step++) {
        r = high(r, -high(q32, r)) << 1;
    }
    return r - NEWTON_ERROR;
}

static inline TARGET lanes size_of(lanes x)
{
    const lanes sign = x >> 31;
    return (x ^ sign) - sign;
}

/* Returns x / z in Q24, round-half-up, |x| at most 16 z; inverse: of z 2^shift. */
static inline TARGET lanes divide(lanes x, lanes z, ulanes shift, ulanes inverse)
{
    const lanes sign = x >> 31, size = (x ^ sign) - sign;
    /* 0 to 3 too small: less than 2^28 2^-27 by the reciprocal, less than 1 by rounding down, a half by the final
     * rounding */
    lanes q = (lanes)(high((ulanes)size << shift, inverse) >> 2);
    /* the remainder of size 2^24 plus half of z, or half of z - 1 where x is negative: 0 up to 4 z */
    lanes rest = (lanes)(((ulanes)size << 24) + (ulanes)((z + sign) >> 1) - (ulanes)q * (ulanes)z);
    const lanes two = rest >= 2 * z;
    q -= 2 * two;
    rest -= 2 * z & two;
    q -= rest >= z;
    return (q ^ sign) - sign;
}

/* Converts Q24 to a place, clamped to 32 bits: bits 24..55 if the upper nine are equal. */
static inline TARGET lanes place(lanes at, int32_t scale, int32_t offset)
{
    const uint64_t base = (uint64_t)((int64_t)offset * (1 << 24) + (1 << 23));
    const pairs even = multiply_signed(at, (lanes){0} + scale) + base;
    const pairs uneven = multiply_signed((lanes)odd(at), (lanes){0} + scale) + base;
    const lanes upper = join(even >> 32, uneven), sign = upper >> 31, fits = (upper >> 23) == sign;
    return (join(even >> 24, uneven << 8) & fits) | (~fits & (sign ^ INT32_MAX));
}

static inline TARGET void ray_block(const t3r_ray_map *map, lanes a, lanes b, bool sloped, lanes *u, lanes *v,
                                    lanes *shown)
{
    const int32_t least = 1 << 18;
    const lanes x = coordinate(map, 0, a, b, sloped), y = coordinate(map, 1, a, b, sloped);
    const lanes z = coordinate(map, 2, a, b, sloped);
    const lanes most = z * map->steepest;
    const lanes any = (z >= least) & (size_of(x) <= most) & (size_of(y) <= most);
    const lanes by = (z & any) | (~any & least);
    ulanes d = (ulanes)by, shift = (ulanes){0};
    for (uint32_t step = 4; step > 0; step >>= 1) { /* below 2^22, 2^24, 2^25 */
        const int32_t bound = 1 << (step == 4 ? 22 : step == 2 ? 24 : 25);
        const ulanes up = (ulanes)((lanes)d < bound) & step;
        d <<= up;
        shift += up;
    }
    const int32_t full = 1 << 26;
    const ulanes up = (ulanes)((lanes)d < full) & 1;
    const ulanes inverse = reciprocal(d << up);
    *u = any & place(divide(x & any, by, shift + up, inverse), map->scale_q16[0], map->offset_q16[0]);
    *v = any & place(divide(y & any, by, shift + up, inverse), map->scale_q16[1], map->offset_q16[1]);
    *shown = z & any;
}

TARGET void RAY_ROW(const t3r_ray_map *map, const int32_t *a_q24, const int32_t *b_q24, uint32_t count,
                    t3r_ray_places *out)
{
    const bool sloped = (map->slope_q30[0] | map->slope_q30[1] | map->slope_q30[2]) != 0;
    for (uint32_t i = 0; i < count; i += LANES) {
        const lanes a = *(const lanes_there *)(a_q24 + i), b = *(const lanes_there *)(b_q24 + i);
        lanes u, v, z;
        ray_block(map, a, b, sloped, &u, &v, &z);
        *(lanes_there *)(out->x_q16 + i) = u;
        *(lanes_there *)(out->y_q16 + i) = v;
        *(lanes_there *)(out->z_q24 + i) = z;
    }
}

#endif
