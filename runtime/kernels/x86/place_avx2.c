/* Splats in a tile, eight at a time. Those centred far from it, whose quadratic takes more bits, are left to plain C.
 */
#include "variants.h"

#ifdef T3R_X86

#include <stddef.h>

#include "core/fixed.h"
#include "kernels/place.h"
#include "lanes_avx2.h"
#include "records.h"

/* Eight splats by field. */
typedef struct eight {
    lanes x_q12, y_q12, a_q30, b_q30, c_q30, colours[2];
    lanes first, last; /* corners of the box, x and y << 16 */
} eight;

static inline T3R_AVX2 __m256i pair_of(const void *low, const void *high)
{
    const __m256i half = _mm256_castsi128_si256(_mm_loadl_epi64((const __m128i *)low));
    return _mm256_inserti128_si256(half, _mm_loadl_epi64((const __m128i *)high), 1);
}

static inline T3R_AVX2 void take(const t3r_splat *splats, const uint32_t list[LANES], eight *e)
{
    const t3r_splat *s[LANES];
    lanes word[8], box[4];
    for (uint32_t i = 0; i < LANES; i++) {
        s[i] = &splats[list[i]];
        word[i] = _mm256_loadu_si256((const __m256i *)(const void *)s[i]);
    }
    for (int i = 0; i < 4; i++) {
        box[i] = pair_of(&s[i]->x0, &s[i + 4]->x0);
    }
    transpose(word);
    e->x_q12 = word[0];
    e->y_q12 = word[1];
    e->a_q30 = word[2];
    e->b_q30 = word[3];
    e->c_q30 = word[4];
    e->colours[0] = word[6];
    e->colours[1] = word[7];
    const lanes a = _mm256_unpacklo_epi32(box[0], box[1]), b = _mm256_unpacklo_epi32(box[2], box[3]);
    e->first = _mm256_unpacklo_epi64(a, b);
    e->last = _mm256_unpackhi_epi64(a, b);
}

/* All bits where a centre lies within T3R_SMALL_SPLAT pixels of the tile, along one axis. */
static inline T3R_AVX2 lanes near(lanes centre_q12, uint32_t tile)
{
    const lanes offset = subtract(centre_q12, all((int32_t)(tile - T3R_SMALL_SPLAT) * (1 << 12)));
    return at_least(all((2 * T3R_SMALL_SPLAT + T3R_TILE_SIDE - 1) << 12), offset);
}

/* A coordinate of the box's corners in the tile: what the box has of 0..15. */
static inline T3R_AVX2 lanes from_of(lanes first, uint32_t tile)
{
    return _mm256_max_epi32(subtract(first, all((int32_t)tile)), all(0));
}

static inline T3R_AVX2 lanes to_of(lanes last, uint32_t tile)
{
    return _mm256_min_epi32(subtract(last, all((int32_t)tile)), all(T3R_TILE_SIDE - 1));
}

/* x / 2^12, round-half-up */
static inline T3R_AVX2 lanes rounded_q18(lanes x_q30)
{
    return _mm256_srai_epi32(add(_mm256_srai_epi32(x_q30, 11), all(1)), 1);
}

/* A half-gradient times 2^12, to be rounded by 12, and what rounding adds. Its distances are below 2^18, so this is
 * below 2^50. */
static inline T3R_AVX2 wide half_gradient(lanes a, lanes dx, lanes b, lanes dy)
{
    return sum(sum(product(a, dx), product(b, dy)), all_wide(1 << 11));
}

/* Of the low halves of 64-bit lanes. */
static inline T3R_AVX2 wide half_product(wide a, wide b)
{
    return (wide){_mm256_mul_epi32(a.even, b.even), _mm256_mul_epi32(a.odd, b.odd)};
}

/* The rounded half-gradient times a distance: its 18 upper bits and its 20 lower ones apart. */
static inline T3R_AVX2 wide along(wide gradient, wide distance)
{
    const wide upper = half_product(right(gradient, 32), distance);
    const __m256i low_bits = _mm256_set1_epi64x((1 << 20) - 1);
    wide lower = right(gradient, 12);
    lower.even = _mm256_and_si256(lower.even, low_bits);
    lower.odd = _mm256_and_si256(lower.odd, low_bits);
    lower = half_product(lower, distance);
    lower.even = _mm256_add_epi64(lower.even, _mm256_slli_epi64(upper.even, 20));
    lower.odd = _mm256_add_epi64(lower.odd, _mm256_slli_epi64(upper.odd, 20));
    return lower;
}

/* What place_group() of plain C does: q, gx and gy about the pixel that is dx and dy from the centre. */
static inline T3R_AVX2 void place_group(const eight *e, lanes dx, lanes dy, lanes group[3])
{
    const wide hx = half_gradient(e->a_q30, dx, e->b_q30, dy), hy = half_gradient(e->b_q30, dx, e->c_q30, dy);
    /* rounded by 12 twice: floor(floor(h / 2^12 + 1/2) / 2^12 + 1/2) = floor(h / 2^24 + 2^-13 + 1/2) */
    const wide half = all_wide(1 << 23), across = {dx, odd_of(dx)}, down = {dy, odd_of(dy)};
    group[0] = low_of(right(sum(sum(along(hx, across), along(hy, down)), all_wide(1 << 24)), 25));
    group[1] = low_of(right(sum(hx, half), 24));
    group[2] = low_of(right(sum(hy, half), 24));
}

/* Four words each of eight records, from `to` on. */
static inline T3R_AVX2 void store_words(const lanes v[4], t3r_tile_splat *placed, size_t to)
{
    const lanes a = _mm256_unpacklo_epi32(v[0], v[1]), b = _mm256_unpackhi_epi32(v[0], v[1]);
    const lanes c = _mm256_unpacklo_epi32(v[2], v[3]), d = _mm256_unpackhi_epi32(v[2], v[3]);
    const lanes rows[4] = {_mm256_unpacklo_epi64(a, c), _mm256_unpackhi_epi64(a, c), _mm256_unpacklo_epi64(b, d),
                           _mm256_unpackhi_epi64(b, d)};
    for (int i = 0; i < 4; i++) {
        _mm_storeu_si128((__m128i *)(void *)((uint8_t *)&placed[i] + to), _mm256_castsi256_si128(rows[i]));
        _mm_storeu_si128((__m128i *)(void *)((uint8_t *)&placed[i + 4] + to), _mm256_extracti128_si256(rows[i], 1));
    }
}

_Static_assert(sizeof(t3r_tile_splat) == 52 && offsetof(t3r_tile_splat, a) == 24 &&
                   offsetof(t3r_tile_splat, opacity_q16) == 36 && offsetof(t3r_tile_splat, column) == 44 &&
                   offsetof(t3r_tile_splat, first) == 47 && offsetof(t3r_tile_splat, x1) == 50,
               "thirteen words");

/* A splat's columns and rows in the tile. */
typedef struct spans {
    lanes x0, y0, x1, y1, column, is_wide;
} spans;

static inline T3R_AVX2 spans spans_of(const eight *e, uint32_t left, uint32_t top)
{
    const lanes low_half = all(0xffff);
    spans s;
    s.x0 = from_of(_mm256_and_si256(e->first, low_half), left);
    s.y0 = from_of(_mm256_srli_epi32(e->first, 16), top);
    s.x1 = to_of(_mm256_and_si256(e->last, low_half), left);
    s.y1 = to_of(_mm256_srli_epi32(e->last, 16), top);
    s.is_wide = _mm256_cmpgt_epi32(subtract(s.x1, s.x0), all(T3R_LANES - 1));
    s.column = _mm256_andnot_si256(s.is_wide, _mm256_min_epi32(s.x0, all(T3R_TILE_SIDE - T3R_LANES)));
    return s;
}

/* The groups, a and b: the first eight words. */
static inline T3R_AVX2 void store_groups(const eight *e, const spans *s, uint32_t left, uint32_t top,
                                         t3r_tile_splat placed[LANES])
{
    const lanes dx = subtract(_mm256_slli_epi32(add(s->column, all((int32_t)left)), 12), e->x_q12);
    const lanes dy = subtract(all((int32_t)(top << 12)), e->y_q12);
    lanes word[8];
    place_group(e, dx, dy, word);
    if (_mm256_testz_si256(s->is_wide, s->is_wide)) {
        word[3] = word[4] = word[5] = all(0);
    } else {
        place_group(e, add(dx, all(T3R_LANES << 12)), dy, word + 3);
    }
    word[6] = rounded_q18(_mm256_srai_epi32(e->a_q30, 1));
    word[7] = rounded_q18(e->b_q30);
    transpose(word);
    for (int i = 0; i < LANES; i++) {
        _mm256_storeu_si256((__m256i *)(void *)&placed[i], word[i]);
    }
}

/* The other five words. */
static inline T3R_AVX2 void store_rest(const eight *e, const spans *s, t3r_tile_splat placed[LANES])
{
    const lanes opacity_q16 = _mm256_slli_epi32(_mm256_srli_epi32(e->colours[1], 16), 1);
    const lanes groups = subtract(all(1), s->is_wide), drawn = subtract(groups, s->is_wide); /* 1 and 1, or 2 and 3 */
    lanes word[5];
    word[0] = rounded_q18(_mm256_srai_epi32(e->c_q30, 1));
    word[1] = _mm256_or_si256(opacity_q16, _mm256_slli_epi32(e->colours[0], 16));
    word[2] = _mm256_or_si256(_mm256_srli_epi32(e->colours[0], 16), _mm256_slli_epi32(e->colours[1], 16));
    word[3] = _mm256_or_si256(s->column, _mm256_slli_epi32(groups, 8));
    word[3] = _mm256_or_si256(word[3], _mm256_slli_epi32(drawn, 16));
    word[3] = _mm256_or_si256(word[3], _mm256_slli_epi32(s->y0, 24));
    word[4] = _mm256_or_si256(s->y1, _mm256_slli_epi32(s->x0, 8));
    word[4] = _mm256_or_si256(word[4], _mm256_slli_epi32(s->x1, 16));
    store_words(word, placed, offsetof(t3r_tile_splat, c));
    store_words(word + 1, placed, offsetof(t3r_tile_splat, opacity_q16)); /* three of them once more, and the last */
}

/* Returns a bit each of those that plain C has to place. */
static T3R_AVX2 uint32_t place_eight(const t3r_splat *splats, const uint32_t list[LANES], uint32_t left, uint32_t top,
                                     t3r_tile_splat placed[LANES])
{
    eight e;
    take(splats, list, &e);
    const spans s = spans_of(&e, left, top);
    store_groups(&e, &s, left, top, placed);
    store_rest(&e, &s, placed);
    const lanes is_small = _mm256_and_si256(near(e.x_q12, left), near(e.y_q12, top));
    return ~(uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(is_small)) & 255u;
}

static T3R_AVX2 void place_up_to_eight(const t3r_splat *splats, const uint32_t *list, uint32_t count, uint32_t left,
                                       uint32_t top, t3r_tile_splat *placed)
{
    uint32_t filled[LANES]; /* behind the last splat, it again */
    for (uint32_t i = 0; i < LANES && count < LANES; i++) {
        filled[i] = list[T3R_MIN(i, count - 1)];
    }
    list = count < LANES ? filled : list;
    for (uint32_t far = place_eight(splats, list, left, top, placed); far != 0; far &= far - 1) {
        const uint32_t lane = (uint32_t)__builtin_ctz(far);
        t3r_place(&splats[list[lane]], left, top, &placed[lane]);
    }
}

T3R_AVX2 void t3r_place_avx2(const t3r_splat *splats, const uint32_t *list, uint32_t count, uint32_t left, uint32_t top,
                             t3r_tile_splat *placed)
{
    for (uint32_t i = 0; i < count; i += LANES) {
        place_up_to_eight(splats, list + i, count - i, left, top, placed + i);
    }
}

#else
typedef int t3r_no_place_avx2; /* a file may not be empty */
#endif
