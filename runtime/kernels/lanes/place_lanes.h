/* SPDX-License-Identifier: Apache-2.0 */
/* Splats in a tile, LANES at a time. Splats centred far from it, whose quadratic takes more bits, are left to plain C.
 * Included after a header of lanes, in a file that names the function PLACE. */
#ifndef T3R_KERNELS_LANES_PLACE_LANES_H
#define T3R_KERNELS_LANES_PLACE_LANES_H

#include "core/fixed.h"
#include "kernels/lanes/vectors/records.h"
#include "kernels/place.h"

/* Splats by field. */
typedef struct fields {
    lanes x_q12, y_q12, a_q30, b_q30, c_q30, colours[2];
    lanes first, last; /* corners of the box, x and y << 16 */
} fields;

static inline T3R_LANES_TARGET void take(const t3r_splat *splats, const uint32_t list[LANES], fields *e)
{
    const uint8_t *from[LANES];
    lanes word[10];
    T3R_LANES_UNROLL for (uint32_t i = 0; i < LANES; i++)
    {
        from[i] = (const uint8_t *)&splats[list[i]];
    }
    read_four(from, 0, word);
    read_four(from, 16, word + 4);
    read_two(from, offsetof(t3r_splat, x0), word + 8);
    e->x_q12 = word[0];
    e->y_q12 = word[1];
    e->a_q30 = word[2];
    e->b_q30 = word[3];
    e->c_q30 = word[4];
    e->colours[0] = word[6];
    e->colours[1] = word[7];
    e->first = word[8];
    e->last = word[9];
}

/* Returns all bits set where a centre lies near the tile along one axis, of which this is its first pixel. */
static inline T3R_LANES_TARGET lanes near(lanes centre_q12, int32_t first_q12, uint32_t spread)
{
    const int32_t near_q12 = t3r_near_q12(spread);
    const lanes offset = subtract(centre_q12, all(first_q12 - near_q12));
    return at_least(all(near_q12 + T3R_NEAR_MOST_Q12), offset);
}

/* Return a coordinate of the box's corners in the tile, clamped to 0..15. */
static inline T3R_LANES_TARGET lanes from_of(lanes first, uint32_t tile)
{
    return OF_LANES(max_epi32)(subtract(first, all((int32_t)tile)), all(0));
}

static inline T3R_LANES_TARGET lanes to_of(lanes last, uint32_t tile)
{
    return OF_LANES(min_epi32)(subtract(last, all((int32_t)tile)), all(T3R_TILE_SIDE - 1));
}

/* Returns x / 2^12, round-half-up. */
static inline T3R_LANES_TARGET lanes rounded_q18(lanes x_q30)
{
    return OF_LANES(srai_epi32)(add(OF_LANES(srai_epi32)(x_q30, 11), all(1)), 1);
}

/* Returns a half-gradient times 2^12, plus half for the later rounding by 12. Distances are below 2^18, so this is
 * below 2^50. */
static inline T3R_LANES_TARGET wide half_gradient(lanes a, lanes dx, lanes b, lanes dy)
{
    return sum(sum(product(a, dx), product(b, dy)), all_wide(1 << 11));
}

/* Multiplies the low halves of 64-bit lanes. */
static inline T3R_LANES_TARGET wide half_product(wide a, wide b)
{
    return (wide){OF_LANES(mul_epi32)(a.even, b.even), OF_LANES(mul_epi32)(a.odd, b.odd)};
}

/* Returns the rounded half-gradient times a distance: its upper 18 and lower 20 bits are multiplied separately. */
static inline T3R_LANES_TARGET wide along(wide gradient, wide distance)
{
    const wide upper = half_product(right(gradient, 32), distance);
    const lanes low_bits = ALL_64((1 << 20) - 1);
    wide lower = right(gradient, 12);
    lower.even = both(lower.even, low_bits);
    lower.odd = both(lower.odd, low_bits);
    lower = half_product(lower, distance);
    lower.even = OF_LANES(add_epi64)(lower.even, OF_LANES(slli_epi64)(upper.even, 20));
    lower.odd = OF_LANES(add_epi64)(lower.odd, OF_LANES(slli_epi64)(upper.odd, 20));
    return lower;
}

/* Computes place_group() of plain C: q, gx and gy at the pixel that is dx and dy from the centre. */
static inline T3R_LANES_TARGET void place_group(const fields *e, lanes dx, lanes dy, lanes group[3])
{
    const wide hx = half_gradient(e->a_q30, dx, e->b_q30, dy), hy = half_gradient(e->b_q30, dx, e->c_q30, dy);
    /* rounded by 12 twice: floor(floor(h / 2^12 + 1/2) / 2^12 + 1/2) = floor(h / 2^24 + 2^-13 + 1/2) */
    const wide half = all_wide(1 << 23), across = spread(dx), down = spread(dy);
    group[0] = low_of(right(sum(sum(along(hx, across), along(hy, down)), all_wide(1 << 24)), 25));
    group[1] = low_of(right(sum(hx, half), 24));
    group[2] = low_of(right(sum(hy, half), 24));
}

_Static_assert(sizeof(t3r_tile_splat) == 52 && offsetof(t3r_tile_splat, a) == 24 &&
                   offsetof(t3r_tile_splat, opacity_q16) == 36 && offsetof(t3r_tile_splat, column) == 44 &&
                   offsetof(t3r_tile_splat, first) == 47 && offsetof(t3r_tile_splat, x1) == 50,
               "thirteen words");

/* A splat's columns and rows in the tile. */
typedef struct spans {
    lanes x0, y0, x1, y1, column, is_wide;
} spans;

static inline T3R_LANES_TARGET spans spans_of(const fields *e, uint32_t left, uint32_t top)
{
    const lanes low_half = all(0xffff);
    spans s;
    s.x0 = from_of(both(e->first, low_half), left);
    s.y0 = from_of(OF_LANES(srli_epi32)(e->first, 16), top);
    s.x1 = to_of(both(e->last, low_half), left);
    s.y1 = to_of(OF_LANES(srli_epi32)(e->last, 16), top);
    s.is_wide = greater(subtract(s.x1, s.x0), all(T3R_LANES - 1));
    s.column = without(s.is_wide, OF_LANES(min_epi32)(s.x0, all(T3R_TILE_SIDE - T3R_LANES)));
    return s;
}

/* Stores the groups, a and b: the first eight words. */
static inline T3R_LANES_TARGET void store_groups(const fields *e, const spans *s, const t3r_tile_place *tile,
                                                 uint8_t *const to[LANES])
{
    const lanes spread_q12 = all(1 << (12 + tile->spread)), spread = all(1 << tile->spread);
    const lanes square = multiply(spread, spread);
    const lanes dx = subtract(multiply(add(s->column, all((int32_t)tile->left)), spread_q12), e->x_q12);
    const lanes dy = subtract(all(tile->top_q12), e->y_q12);
    lanes word[8];
    place_group(e, dx, dy, word);
    if (signs_of(s->is_wide) == 0) {
        word[3] = word[4] = word[5] = all(0);
    } else {
        place_group(e, add(dx, multiply(all(T3R_LANES), spread_q12)), dy, word + 3);
        word[4] = multiply(word[4], spread);
        word[5] = multiply(word[5], spread);
    }
    word[1] = multiply(word[1], spread);
    word[2] = multiply(word[2], spread);
    word[6] = multiply(rounded_q18(OF_LANES(srai_epi32)(e->a_q30, 1)), square);
    word[7] = multiply(rounded_q18(e->b_q30), square);
    write_four(word, to, 0);
    write_four(word + 4, to, 16);
}

/* Stores the other five words. */
static inline T3R_LANES_TARGET void store_rest(const fields *e, const spans *s, uint32_t spread,
                                               uint8_t *const to[LANES])
{
    const lanes opacity_q16 = OF_LANES(slli_epi32)(OF_LANES(srli_epi32)(e->colours[1], 16), 1);
    const lanes groups = subtract(all(1), s->is_wide), drawn = subtract(groups, s->is_wide); /* 1 and 1, or 2 and 3 */
    lanes word[5];
    word[0] = multiply(rounded_q18(OF_LANES(srai_epi32)(e->c_q30, 1)), all(1 << (2 * spread)));
    word[1] = either(opacity_q16, OF_LANES(slli_epi32)(e->colours[0], 16));
    word[2] = either(OF_LANES(srli_epi32)(e->colours[0], 16), OF_LANES(slli_epi32)(e->colours[1], 16));
    word[3] = either(s->column, OF_LANES(slli_epi32)(groups, 8));
    word[3] = either(word[3], OF_LANES(slli_epi32)(drawn, 16));
    word[3] = either(word[3], OF_LANES(slli_epi32)(s->y0, 24));
    word[4] = either(s->y1, OF_LANES(slli_epi32)(s->x0, 8));
    word[4] = either(word[4], OF_LANES(slli_epi32)(s->x1, 16));
    write_four(word, to, offsetof(t3r_tile_splat, c));
    write_four(word + 1, to, offsetof(t3r_tile_splat, opacity_q16)); /* repeats three of them to store the last */
}

/* Returns a bit for each splat that plain C has to place. */
static T3R_LANES_TARGET uint32_t place_lanes(const t3r_splat *splats, const uint32_t list[LANES],
                                             const t3r_tile_place *tile, t3r_tile_splat placed[LANES])
{
    uint8_t *to[LANES];
    fields e;
    T3R_LANES_UNROLL for (int i = 0; i < LANES; i++)
    {
        to[i] = (uint8_t *)&placed[i];
    }
    take(splats, list, &e);
    const spans s = spans_of(&e, tile->left, tile->top);
    store_groups(&e, &s, tile, to);
    store_rest(&e, &s, tile->spread, to);
    const lanes is_small =
        both(near(e.x_q12, tile->left_q12, tile->spread), near(e.y_q12, tile->top_q12, tile->spread));
    return ~signs_of(is_small) & ((1u << LANES) - 1);
}

static T3R_LANES_TARGET void place_up_to_lanes(const t3r_splat *splats, const uint32_t *list, uint32_t count,
                                               const t3r_tile_place *tile, t3r_tile_splat *placed)
{
    uint32_t filled[LANES]; /* pads by repeating the last splat */
    for (uint32_t i = 0; i < LANES && count < LANES; i++) {
        filled[i] = list[T3R_MIN(i, count - 1)];
    }
    list = count < LANES ? filled : list;
    for (uint32_t far = place_lanes(splats, list, tile, placed); far != 0; far &= far - 1) {
        const uint32_t lane = (uint32_t)__builtin_ctz(far);
        t3r_place(&splats[list[lane]], tile, &placed[lane]);
    }
}

T3R_LANES_TARGET void PLACE(const t3r_splat *splats, const uint32_t *list, uint32_t count, const t3r_tile_place *tile,
                            t3r_tile_splat *placed)
{
    for (uint32_t i = 0; i < count; i += LANES) {
        place_up_to_lanes(splats, list + i, count - i, tile, placed + i);
    }
}

#endif
