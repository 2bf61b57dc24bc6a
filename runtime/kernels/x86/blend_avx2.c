/* Blending, sixteen pixels at a time: two rows of eight columns, or a row of the tile. */
#include "variants.h"

#ifdef T3R_X86

#include "sixteen.h"

#include "core/memory.h"
#include "kernels/alpha.h"

/* (a b + 2^15) / 2^16 of 16 unsigned bits: the high half and the top bit of the low one. */
static inline T3R_AVX2 __m256i mulr_q16(__m256i a, __m256i b)
{
    return _mm256_add_epi16(_mm256_mulhi_epu16(a, b), _mm256_srli_epi16(_mm256_mullo_epi16(a, b), 15));
}

/* The same from twice b: (a b / 2^15 + 1) / 2, both rounded down. */
static inline T3R_AVX2 __m256i mulr_q16_doubled(__m256i a, __m256i twice_b)
{
    return _mm256_avg_epu16(_mm256_mulhi_epu16(a, twice_b), _mm256_setzero_si256());
}

static inline T3R_AVX2 __m256i constant(uint32_t x)
{
    return _mm256_set1_epi16((int16_t)x);
}

/* All bits where a >= b, of 16 unsigned bits. */
static inline T3R_AVX2 __m256i at_least(__m256i a, __m256i b)
{
    return _mm256_cmpeq_epi16(_mm256_max_epu16(a, b), a);
}

/* A lane for each of 128 bits. */
static inline T3R_AVX2 __m256i both_halves(int32_t low, int32_t high)
{
    return _mm256_inserti128_si256(_mm256_set1_epi32(low), _mm_set1_epi32(high), 1);
}

/* Sixteen pixels, eight of a row in each half: the first four columns of both halves, and the last four. What is left
 * of T3R_ALPHA_RANGE when q / 8 is taken away, 16 times, with the half that rounds; modulo 2^32, as plain C's sums are
 * without overflow. */
typedef struct quadratic {
    __m256i left[2], step[2], bend; /* from step to step, and what steps lose */
} quadratic;

static inline T3R_AVX2 void advance(quadratic *q)
{
    for (int k = 0; k < 2; k++) {
        q->left[k] = _mm256_sub_epi32(q->left[k], q->step[k]);
        q->step[k] = _mm256_add_epi32(q->step[k], q->bend);
    }
}

/* low, high: the halves' groups; rows: how far the high half's row is below the low one's, and `every` how many rows a
 * step goes down. */
static inline T3R_AVX2 quadratic quadratic_of(const t3r_tile_splat *s, uint32_t low, uint32_t high, int32_t rows,
                                              int32_t every)
{
    const int32_t row[2] = {s->first, s->first + rows}, gy[2] = {s->group[low].gy, s->group[high].gy};
    const int32_t q[2] = {s->group[low].q + row[0] * (gy[0] + row[0] * s->c),
                          s->group[high].q + row[1] * (gy[1] + row[1] * s->c)};
    const __m256i at = both_halves(16 * T3R_ALPHA_RANGE + 7 - q[0], 16 * T3R_ALPHA_RANGE + 7 - q[1]);
    const __m256i slope = both_halves(s->group[low].gx + row[0] * s->b, s->group[high].gx + row[1] * s->b);
    const __m256i a = _mm256_set1_epi32(s->a), b = _mm256_set1_epi32(every * s->b);
    const __m256i down =
        both_halves(every * (gy[0] + (2 * row[0] + every) * s->c), every * (gy[1] + (2 * row[1] + every) * s->c));
    quadratic out = {.bend = _mm256_set1_epi32(2 * every * every * s->c)};
    for (int k = 0; k < 2; k++) {
        const __m256i i = _mm256_add_epi32(_mm256_setr_epi32(0, 1, 2, 3, 0, 1, 2, 3), _mm256_set1_epi32(4 * k));
        const __m256i across = _mm256_mullo_epi32(i, _mm256_add_epi32(slope, _mm256_mullo_epi32(i, a)));
        out.left[k] = _mm256_sub_epi32(at, across);
        out.step[k] = _mm256_add_epi32(down, _mm256_mullo_epi32(i, b));
    }
    return out;
}

static inline T3R_AVX2 __m256i alpha_of(const quadratic *q, __m256i opacity_q16)
{
    /* packing holds it to 0 and above */
    __m256i s = _mm256_packus_epi32(_mm256_srai_epi32(q->left[0], 4), _mm256_srai_epi32(q->left[1], 4));
    s = _mm256_min_epu16(s, constant(T3R_ALPHA_RANGE));
    __m256i p = _mm256_add_epi16(constant(T3R_ALPHA_C3), _mm256_mulhi_epu16(s, constant(T3R_ALPHA_C4)));
    p = _mm256_add_epi16(constant(T3R_ALPHA_C2), _mm256_mulhi_epu16(s, p));
    p = _mm256_add_epi16(constant(T3R_ALPHA_C1), _mm256_mulhi_epu16(s, p));
    p = _mm256_add_epi16(constant(T3R_ALPHA_C0), _mm256_mulhi_epu16(s, p));
    p = _mm256_mulhi_epu16(p, p);
    p = _mm256_mulhi_epu16(p, p);
    p = _mm256_mulhi_epu16(p, p);
    __m256i alpha = _mm256_min_epu16(_mm256_mulhi_epu16(p, opacity_q16), constant(T3R_ALPHA_MOST_Q16));
    return _mm256_and_si256(alpha, at_least(alpha, constant(T3R_ALPHA_LEAST_Q16)));
}

/* What blending a splat needs at each step. */
typedef struct blend_job {
    t3r_tile *tile;
    __m256i opacity, colour[3];        /* colours twice */
    __m256i drawn;                     /* all bits in the halves that are */
    __m256i any;                       /* the bits of the weights that are kept */
    t3r_blended_row *rows, *high_rows; /* of both halves, or NULL; known where this is inlined */
} blend_job;

T3R_X86_INLINE T3R_AVX2 void blend_step(blend_job *job, const quadratic *q, uint32_t place, t3r_sixteen pixels)
{
    uint16_t *transmittance = job->tile->transmittance_q16[0] + place;
    const __m256i t = t3r_load_sixteen(transmittance, pixels);
    __m256i alpha = _mm256_and_si256(alpha_of(q, job->opacity), at_least(t, constant(T3R_STOP_Q16)));
    if (pixels == T3R_WHOLE_ROW) {
        alpha = _mm256_and_si256(alpha, job->drawn);
    }
    const __m256i w = mulr_q16(t, alpha); /* 0 where there is no pixel */
    t3r_store_sixteen(transmittance, pixels, _mm256_sub_epi16(t, w));
    for (int c = 0; c < 3; c++) {
        uint16_t *colour = job->tile->colour_q7[c][0] + place;
        t3r_store_sixteen(colour, pixels,
                          _mm256_add_epi16(t3r_load_sixteen(colour, pixels), mulr_q16_doubled(w, job->colour[c])));
    }
    if (job->rows != NULL) {
        const __m256i still = _mm256_cmpeq_epi16(w, _mm256_setzero_si256());
        alpha = _mm256_andnot_si256(still, _mm256_srli_epi16(alpha, 1));
        _mm256_storeu_si256((__m256i *)(void *)job->rows, _mm256_permute2x128_si256(w, alpha, 0x20));
        if (pixels != T3R_ONE_ROW) {
            _mm256_storeu_si256((__m256i *)(void *)job->high_rows, _mm256_permute2x128_si256(w, alpha, 0x31));
        }
        job->any = _mm256_or_si256(job->any, w);
        job->rows += pixels == T3R_TWO_ROWS ? 2 : 1;
        job->high_rows += pixels == T3R_TWO_ROWS ? 2 : 1;
    }
}

/* One group, a pair of rows at a time. */
T3R_X86_INLINE T3R_AVX2 void blend_group(blend_job *job, const t3r_tile_splat *splat, uint32_t group)
{
    quadratic q = quadratic_of(splat, group, group, 1, 2);
    uint32_t row = splat->first, place = row * T3R_TILE_SIDE + splat->column + group * T3R_LANES;
    for (; row < splat->last; row += 2, place += 2u * T3R_TILE_SIDE) {
        blend_step(job, &q, place, T3R_TWO_ROWS);
        advance(&q);
    }
    if (row == splat->last) {
        blend_step(job, &q, place, T3R_ONE_ROW);
    }
}

/* Both groups, a whole row of the tile at a time. */
T3R_X86_INLINE T3R_AVX2 void blend_rows(blend_job *job, const t3r_tile_splat *splat)
{
    quadratic q = quadratic_of(splat, 0, 1, 0, 1);
    for (uint32_t row = splat->first; row <= splat->last; row++) {
        blend_step(job, &q, row * T3R_TILE_SIDE, T3R_WHOLE_ROW);
        advance(&q);
    }
}

static inline T3R_AVX2 blend_job begun(t3r_tile *tile, const t3r_tile_splat *splat)
{
    blend_job job = {.tile = tile, .opacity = constant(splat->opacity_q16), .any = _mm256_setzero_si256()};
    for (int c = 0; c < 3; c++) {
        job.colour[c] = constant(2u * splat->colour_q7[c]);
    }
    job.drawn = both_halves(-(splat->drawn & 1), -(splat->drawn >> 1 & 1));
    return job;
}

T3R_AVX2 void t3r_blend_avx2(t3r_tile *tile, const t3r_tile_splat *splat)
{
    blend_job job = begun(tile, splat);
    job.rows = job.high_rows = NULL;
    if (splat->drawn == 3) {
        blend_rows(&job, splat);
    } else if (splat->drawn != 0) {
        blend_group(&job, splat, splat->drawn == 1 ? 0 : 1);
    }
}

T3R_AVX2 uint16_t t3r_blend_keep_avx2(t3r_tile *restrict tile, const t3r_tile_splat *splat,
                                      t3r_blended_row *restrict rows)
{
    blend_job job = begun(tile, splat);
    job.rows = rows;
    if (splat->groups == 2) {
        job.high_rows = rows + (splat->last - splat->first + 1u);
        blend_rows(&job, splat);
    } else if (splat->drawn != 0) {
        job.high_rows = rows + 1;
        blend_group(&job, splat, 0);
    } else {
        memset(rows, 0, (splat->last - splat->first + 1u) * sizeof *rows);
    }
    __m128i bits = _mm_or_si128(_mm256_castsi256_si128(job.any), _mm256_extracti128_si256(job.any, 1));
    bits = _mm_or_si128(bits, _mm_srli_si128(bits, 8));
    bits = _mm_or_si128(bits, _mm_srli_si128(bits, 4));
    return (uint16_t)((uint32_t)_mm_cvtsi128_si32(bits) | (uint32_t)_mm_cvtsi128_si32(bits) >> 16);
}

#else
typedef int t3r_no_blend_avx2; /* a file may not be empty */
#endif
