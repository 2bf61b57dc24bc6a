/* Corrections, eight Gaussians at a time: solve.c step by step, a Gaussian a lane of 32 bits. */
#include "variants.h"

#ifdef T3R_X86

#include "intrinsics.h"

#include "core/fixed.h"
#include "kernels/solve_parts.h"

#define LANES 8
#define PARAMETERS T3R_REFINE_PARAMETERS

typedef int32_t lanes __attribute__((vector_size(LANES * sizeof(int32_t))));
typedef uint32_t ulanes __attribute__((vector_size(LANES * sizeof(uint32_t))));

static inline T3R_AVX2 lanes all_of(int32_t x)
{
    return (lanes)_mm256_set1_epi32(x);
}

static inline T3R_AVX2 lanes least(lanes a, lanes b)
{
    return (lanes)_mm256_min_epi32((__m256i)a, (__m256i)b);
}

static inline T3R_AVX2 lanes most(lanes a, lanes b)
{
    return (lanes)_mm256_max_epi32((__m256i)a, (__m256i)b);
}

static inline T3R_AVX2 lanes held(lanes x, lanes bound)
{
    return most(least(x, bound), -bound);
}

/* b where the mask has ones, else a */
static inline T3R_AVX2 lanes chosen(lanes mask, lanes b, lanes a)
{
    return (lanes)_mm256_blendv_epi8((__m256i)a, (__m256i)b, (__m256i)mask);
}

/* Shifts by 32 and more, or by less than 0, give 0; those of signed numbers to the right the sign. */
static inline T3R_AVX2 lanes left(lanes x, lanes by)
{
    return (lanes)_mm256_sllv_epi32((__m256i)x, (__m256i)by);
}

/* By 1 and more, round-half-up */
static inline T3R_AVX2 lanes rounded_right(lanes x, lanes by)
{
    return ((lanes)_mm256_srav_epi32((__m256i)x, (__m256i)(by - 1)) + 1) >> 1;
}

/* t3r_scale32() */
static inline T3R_AVX2 lanes scaled(lanes x, lanes up)
{
    return chosen(up < 0, rounded_right(x, -up), left(x, up));
}

/* t3r_msb32(), and 0 of 0 */
static inline T3R_AVX2 lanes highest_bit(lanes x)
{
    const __m256i of_nibble =
        _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 0, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3));
    lanes bit = {0};
    for (int32_t by = 16; by >= 4; by /= 2) {
        const lanes high = (lanes)((ulanes)x >> by), some = high > 0;
        x = chosen(some, high, x);
        bit += some & by;
    }
    return bit + (lanes)_mm256_shuffle_epi8(of_nibble, (__m256i)x);
}

/* x[k] becomes word k of the eight records, of which it was one each. */
static inline T3R_AVX2 void transpose(__m256i x[LANES])
{
    __m256i pairs[LANES], fours[LANES];
    for (int i = 0; i < LANES; i += 2) {
        pairs[i] = _mm256_unpacklo_epi32(x[i], x[i + 1]);
        pairs[i + 1] = _mm256_unpackhi_epi32(x[i], x[i + 1]);
    }
    for (int i = 0; i < LANES; i += 4) {
        for (int k = 0; k < 2; k++) {
            fours[i + 2 * k] = _mm256_unpacklo_epi64(pairs[i + k], pairs[i + k + 2]);
            fours[i + 2 * k + 1] = _mm256_unpackhi_epi64(pairs[i + k], pairs[i + k + 2]);
        }
    }
    for (int k = 0; k < 4; k++) {
        x[k] = _mm256_permute2x128_si256(fours[k], fours[k + 4], 0x20);
        x[k + 4] = _mm256_permute2x128_si256(fours[k], fours[k + 4], 0x31);
    }
}

/* The sums of eight Gaussians by field: gradient, curvature, area, axes; behind the last Gaussian, it again. */
#define FIRST_WORD (offsetof(t3r_refine_sums, gradient) / sizeof(int32_t))
#define WORDS (sizeof(t3r_refine_sums) / sizeof(int32_t) - FIRST_WORD)
enum { GRADIENT, CURVATURE = T3R_REFINE_MOMENTS_2, AREA = CURVATURE + T3R_REFINE_MOMENTS_4 };
_Static_assert(WORDS % LANES == 0 && sizeof(t3r_refine_sums) % sizeof(int32_t) == 0, "whole transpositions");

static inline T3R_AVX2 void take(const t3r_refine_sums *sums, uint32_t count, lanes words[WORDS])
{
    for (uint32_t first = 0; first < WORDS; first += LANES) {
        __m256i x[LANES];
        for (uint32_t i = 0; i < LANES; i++) {
            const int32_t *record = (const int32_t *)(const void *)&sums[T3R_MIN(i, count - 1)];
            x[i] = _mm256_loadu_si256((const __m256i *)(const void *)(record + FIRST_WORD + first));
        }
        transpose(x);
        for (uint32_t k = 0; k < LANES; k++) {
            words[first + k] = (lanes)x[k];
        }
    }
}

typedef struct equations {
    lanes a[PARAMETERS][PARAMETERS], b[PARAMETERS], damping, a_up, b_up;
} equations;

/* room_of() */
static inline T3R_AVX2 lanes room_of(const lanes *x, int count, int32_t bits)
{
    lanes all = {0};
    for (int i = 0; i < count; i++) {
        all |= x[i] ^ (x[i] >> 31);
    }
    return chosen(all == 0, all_of(bits), bits - 1 - highest_bit(all));
}

static inline T3R_AVX2 void normal_equations(const lanes words[WORDS], equations *e)
{
    const lanes wide = most(highest_bit(most(words[AREA], all_of(1)) - 1) - 5, all_of(0)); /* t3r_refine_shift() */
    const lanes damping =
        4 * most((lanes)_mm256_srav_epi32(_mm256_set1_epi32(128 * DAMPING), (__m256i)wide), all_of(1));
    const lanes most_up = DAMPING_BITS - highest_bit(damping);
    e->b_up = room_of(words + GRADIENT, T3R_REFINE_MOMENTS_2, GRADIENT_BITS);
    e->a_up = least(room_of(words + CURVATURE, T3R_REFINE_MOMENTS_4, CURVATURE_BITS), most_up);
    e->damping = scaled(damping, e->a_up);
    lanes g[T3R_REFINE_MOMENTS_2], c[T3R_REFINE_MOMENTS_4];
    for (int k = 0; k < T3R_REFINE_MOMENTS_2; k++) {
        g[k] = scaled(words[GRADIENT + k], e->b_up);
    }
    for (int k = 0; k < T3R_REFINE_MOMENTS_4; k++) {
        c[k] = scaled(words[CURVATURE + k], e->a_up);
    }
    const lanes m = c[T3R_M_1], x = c[T3R_M_X], y = c[T3R_M_Y];
    const lanes xx = c[T3R_M_X2], xy = c[T3R_M_XY], yy = c[T3R_M_Y2];
    e->a[0][0] = 4 * m;
    e->a[1][0] = 4 * x;
    e->a[1][1] = 4 * xx;
    e->a[2][0] = 4 * y;
    e->a[2][1] = 4 * xy;
    e->a[2][2] = 4 * yy;
    e->a[3][0] = 4 * xx - 2 * m;
    e->a[3][1] = 4 * c[T3R_M_X3] - 2 * x;
    e->a[3][2] = 4 * c[T3R_M_X2Y] - 2 * y;
    e->a[3][3] = 4 * c[T3R_M_X4] - 4 * xx + m;
    e->a[4][0] = 8 * xy;
    e->a[4][1] = 8 * c[T3R_M_X2Y];
    e->a[4][2] = 8 * c[T3R_M_XY2];
    e->a[4][3] = 8 * c[T3R_M_X3Y] - 4 * xy;
    e->a[4][4] = 16 * c[T3R_M_X2Y2];
    e->a[5][0] = 4 * yy - 2 * m;
    e->a[5][1] = 4 * c[T3R_M_XY2] - 2 * x;
    e->a[5][2] = 4 * c[T3R_M_Y3] - 2 * y;
    e->a[5][3] = 4 * c[T3R_M_X2Y2] - 2 * xx - 2 * yy + m;
    e->a[5][4] = 8 * c[T3R_M_XY3] - 4 * xy;
    e->a[5][5] = 4 * c[T3R_M_Y4] - 4 * yy + m;
    e->b[0] = 4 * g[0];
    e->b[1] = 4 * g[1];
    e->b[2] = 4 * g[2];
    e->b[3] = 4 * g[3] - 2 * g[0];
    e->b[4] = 8 * g[4];
    e->b[5] = 4 * g[5] - 2 * g[0];
}

typedef struct inverse_root {
    lanes root, straight, up;
} inverse_root;

/* inverse_root_of() */
static inline T3R_AVX2 inverse_root inverse_root_of(lanes d)
{
    const lanes up = (31 - highest_bit(d)) >> 1;
    const ulanes f = (ulanes)left(d, 2 * up) >> 16;
    ulanes y = ROOT_C0 - ((f * (ROOT_C1 - ((f * ROOT_C2) >> 16))) >> 16);
    for (int step = 0; step < 2; step++) {
        const ulanes half = y >> 1, square = (half * half) >> 14;
        const ulanes part = (f * square) >> 15;
        y = (half * ((3u << 15) - part)) >> 15;
    }
    const lanes root = least((lanes)y, all_of(UINT16_MAX));
    return (inverse_root){root, (lanes)((f * (ulanes)root) >> 15), up};
}

/* correlation_of() */
static inline T3R_AVX2 lanes correlation_of(lanes a, const inverse_root *i, const inverse_root *j)
{
    const lanes whole = all_of(INT16_MAX), half = (held(scaled(a, i->up + j->up - 17), whole) * i->root) >> 16;
    return held((half * j->root) >> 14, whole);
}

/* Two numbers of 16 bits a lane, as a product of pairs takes them. */
static inline T3R_AVX2 __m256i paired(lanes even, lanes odd)
{
    return _mm256_blend_epi16((__m256i)even, (__m256i)(odd << 16), 0xaa);
}

/* What the sweeps go over. */
typedef struct unit_system {
    __m256i a_q15[PARAMETERS][PARAMETERS / 2]; /* pairs of a row */
    lanes b[PARAMETERS];                       /* the right sides, with the half that rounds */
    lanes most[PARAMETERS];                    /* of the unknowns */
} unit_system;

static T3R_AVX2 void sweep(const unit_system *s, lanes y[PARAMETERS])
{
    __m256i pairs[PARAMETERS / 2] = {_mm256_setzero_si256(), _mm256_setzero_si256(), _mm256_setzero_si256()};
    for (int step = 0; step < SWEEPS; step++) {
        for (int i = 0; i < PARAMETERS; i++) {
            ulanes rest = (ulanes)s->b[i]; /* modulo 2^32: the result is below 2^31 */
            for (int k = 1; k <= PARAMETERS / 2; k++) { /* the pair with the newest unknown last */
                const int pair = ((i + PARAMETERS - 1) / 2 + k) % (PARAMETERS / 2);
                rest -= (ulanes)_mm256_madd_epi16(s->a_q15[i][pair], pairs[pair]);
            }
            const lanes x = held((lanes)rest >> 15, s->most[i]);
            pairs[i / 2] = i % 2 == 0 ? _mm256_blend_epi16(pairs[i / 2], (__m256i)x, 0x55)
                                      : _mm256_blend_epi16(pairs[i / 2], (__m256i)(x << 16), 0xaa);
        }
    }
    for (int i = 0; i < PARAMETERS; i++) {
        y[i] = i % 2 == 0 ? ((lanes)pairs[i / 2] << 16) >> 16 : (lanes)pairs[i / 2] >> 16;
    }
}

static inline T3R_AVX2 lanes correlation(const equations *e, int i, int j)
{
    return i == j ? all_of(0) : e->a[T3R_MAX(i, j)][T3R_MIN(i, j)];
}

/* solve(); beside the diagonal, the matrix becomes the correlations. */
static T3R_AVX2 void solve(equations *e, lanes x_q16[PARAMETERS])
{
    inverse_root root[PARAMETERS];
    lanes top = {0};
    for (int i = 0; i < PARAMETERS; i++) {
        const lanes square = most(e->a[i][i], all_of(0));
        const lanes diagonal = square + (square >> 4) * RELATIVE_DAMPING_Q4 + e->damping;
        root[i] = inverse_root_of(diagonal - (diagonal == 0));
        const lanes size = (lanes)_mm256_abs_epi32((__m256i)e->b[i]);
        top = most(top, (highest_bit(size) + root[i].up) & (size != 0));
        for (int j = 0; j < i; j++) {
            e->a[i][j] = correlation_of(e->a[i][j], &root[i], &root[j]);
        }
    }
    unit_system s;
    for (int i = 0; i < PARAMETERS; i++) {
        const lanes side = scaled(e->b[i], root[i].up + 14 - top);
        s.b[i] = (((side * (lanes)((ulanes)root[i].root >> 1)) >> 19) << 15) + (1 << 14);
        const lanes up = e->b_up - e->a_up + 28 - top - root[i].up, whole = all_of(INT16_MAX);
        s.most[i] = chosen(up < 0, least(rounded_right(root[i].straight, -up), whole), whole);
        for (int k = 0; k < PARAMETERS / 2; k++) {
            s.a_q15[i][k] = paired(correlation(e, i, 2 * k), correlation(e, i, 2 * k + 1));
        }
    }
    lanes y[PARAMETERS];
    sweep(&s, y);
    for (int i = 0; i < PARAMETERS; i++) {
        const lanes up = least(top + root[i].up + e->a_up - e->b_up - 40, all_of(UP_MOST));
        const lanes x = y[i] * root[i].root;
        /* Held before it is raised, at what leaves the bound but still fits. */
        const lanes bound = (lanes)_mm256_srlv_epi32(_mm256_set1_epi32(SOLUTION_MOST_Q16), (__m256i)up) + 1;
        x_q16[i] = held(chosen(up < 0, rounded_right(x, -up), left(held(x, bound), up)), all_of(SOLUTION_MOST_Q16));
    }
}

static T3R_AVX2 void correct(const t3r_refine_sums *sums, uint32_t count, t3r_correction *corrections)
{
    lanes words[WORDS], x_q16[PARAMETERS];
    equations e;
    take(sums, count, words);
    normal_equations(words, &e);
    solve(&e, x_q16);
    for (uint32_t i = 0; i < count; i++) {
        if (sums[i].weight <= 0) {
            corrections[i] = (t3r_correction){{0}, {0}, 0};
            continue;
        }
        t3r_solution solution;
        for (int k = 0; k < PARAMETERS; k++) {
            solution.diagonal[k] = e.a[k][k][i];
            solution.x_q16[k] = x_q16[k][i];
        }
        corrections[i] = t3r_correction_of(&sums[i], &solution, &corrections[i]);
    }
}

T3R_AVX2 void t3r_solve_avx2(const t3r_refine_sums *sums, uint32_t count, t3r_correction *corrections)
{
    for (uint32_t i = 0; i < count; i += LANES) {
        correct(sums + i, T3R_MIN(count - i, LANES), corrections + i);
    }
}

#else
typedef int t3r_no_solve_avx2; /* a file may not be empty */
#endif
