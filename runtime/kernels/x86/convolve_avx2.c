/* A layer at two pixels and four outputs at a time: sixteen taps a step, by pairs. */
#include "variants.h"

#ifdef T3R_X86

#include "requantize.h"

#define TAPS 16u /* of a step */
#define PIXELS 2u

_Static_assert(TAPS == T3R_COLUMN_TAPS, "a column of fewer taps fills a step");

/* What the four outputs have under one run of the kernel. */
typedef struct weight_rows {
    const uint8_t *of[T3R_FOUR];
} weight_rows;

/* Sixteen activations. */
static inline T3R_AVX2 __m256i widened(const int8_t *x)
{
    return _mm256_cvtepi8_epi16(_mm_loadu_si128((const __m128i_u *)(const void *)x));
}

static inline T3R_AVX2 __m256i weights_at(const uint8_t *weights, size_t tap, uint32_t bytes)
{
    return bytes == 1 ? widened((const int8_t *)weights + tap)
                      : _mm256_loadu_si256((const __m256i_u *)(const void *)(weights + tap * 2));
}

typedef __m256i sums[PIXELS][T3R_FOUR];

/* Adds the products of sixteen taps, where `kept` has ones. A sum of two products is at most 2^23. */
static inline T3R_AVX2 void add_step(sums s, const int8_t *const x[PIXELS], const weight_rows *w, size_t tap,
                                     uint32_t bytes, __m256i kept)
{
    const __m256i x0 = widened(x[0] + tap), x1 = widened(x[1] + tap);
    for (uint32_t o = 0; o < T3R_FOUR; o++) {
        const __m256i weights = _mm256_and_si256(weights_at(w->of[o], tap, bytes), kept);
        s[0][o] = _mm256_add_epi32(s[0][o], _mm256_madd_epi16(x0, weights));
        s[1][o] = _mm256_add_epi32(s[1][o], _mm256_madd_epi16(x1, weights));
    }
}

/* Ones in the last `count` of sixteen lanes. */
static inline T3R_AVX2 __m256i last_lanes(uint32_t count)
{
    const __m256i lane = _mm256_setr_epi16(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    return _mm256_cmpgt_epi16(lane, _mm256_set1_epi16((int16_t)(TAPS - 1 - count)));
}

/* A lane's four sums added up: those of four outputs, each from the halves of the first pixel and of the second. */
static inline T3R_AVX2 __m256i added_up(sums s)
{
    __m256i half[PIXELS];
    for (uint32_t p = 0; p < PIXELS; p++) {
        half[p] = _mm256_hadd_epi32(_mm256_hadd_epi32(s[p][0], s[p][1]), _mm256_hadd_epi32(s[p][2], s[p][3]));
    }
    return _mm256_add_epi32(_mm256_permute2x128_si256(half[0], half[1], 0x20),
                            _mm256_permute2x128_si256(half[0], half[1], 0x31));
}

/* Four outputs at two pixels. The last step of a run that is no multiple of sixteen begins before the end of the step
 * before, and drops what that had. */
static inline T3R_AVX2 __m256i dot(const t3r_block *block, const uint32_t pixel[PIXELS], weight_rows w, uint32_t bytes)
{
    const uint32_t whole = block->run / TAPS * TAPS, left = block->run - whole;
    const __m256i all = _mm256_set1_epi16(-1), kept = last_lanes(left);
    sums s;
    for (uint32_t o = 0; o < T3R_FOUR; o++) {
        s[0][o] = s[1][o] = _mm256_setzero_si256();
    }
    for (uint32_t r = 0; r < block->rows; r++) {
        const int8_t *row = (const int8_t *)block->row[r] + block->first;
        const int8_t *const x[PIXELS] = {row + (size_t)pixel[0] * block->step, row + (size_t)pixel[1] * block->step};
        for (uint32_t tap = 0; tap < whole; tap += TAPS) {
            add_step(s, x, &w, tap, bytes, all);
        }
        if (left > 0) {
            add_step(s, x, &w, whole - (TAPS - left), bytes, kept);
        }
        for (uint32_t o = 0; o < T3R_FOUR; o++) {
            w.of[o] += (size_t)block->run * bytes;
        }
    }
    return added_up(s);
}

/* A column of fewer than sixteen taps goes on with zeros: its weights have to go on with something. */
typedef struct short_weights {
    uint8_t of[T3R_FOUR][TAPS * 2];
} short_weights;

static void lengthen(weight_rows *w, uint32_t taps, uint32_t bytes, short_weights *longer)
{
    for (uint32_t o = 0; o < T3R_FOUR; o++) {
        for (uint32_t i = 0; i < TAPS * bytes; i++) {
            longer->of[o][i] = i < taps * bytes ? w->of[o][i] : 0;
        }
        w->of[o] = longer->of[o];
    }
}

static inline __attribute__((always_inline)) T3R_AVX2 void
convolve(const t3r_convolution *layer, const t3r_block *block, uint32_t bytes, void *out, uint32_t out_pitch)
{
    t3r_block filled = *block;
    filled.run = block->run < TAPS ? TAPS : block->run;
    for (uint32_t first = 0; first < layer->outputs; first += T3R_FOUR) {
        const uint32_t count = layer->outputs - first < T3R_FOUR ? layer->outputs - first : T3R_FOUR;
        const t3r_x86_scaling scaling = t3r_x86_scaling_of(layer, first);
        weight_rows w;
        short_weights longer;
        for (uint32_t o = 0; o < T3R_FOUR; o++) { /* behind the last output, it again */
            w.of[o] = layer->weights + (size_t)(first + (o < count ? o : count - 1)) * layer->taps * bytes;
        }
        if (filled.run > block->run) {
            lengthen(&w, layer->taps, bytes, &longer);
        }
        for (uint32_t i = 0; i < block->pixels; i += PIXELS) {
            const uint32_t pixel[PIXELS] = {i, i + 1 < block->pixels ? i + 1 : i};
            const __m256i x = t3r_x86_scaled(dot(&filled, pixel, w, bytes), &scaling, layer->zero);
            t3r_x86_write(_mm256_castsi256_si128(x), layer->output_bits, count, out,
                          (size_t)pixel[0] * out_pitch + first);
            t3r_x86_write(_mm256_extracti128_si256(x, 1), layer->output_bits, count, out,
                          (size_t)pixel[1] * out_pitch + first);
        }
    }
}

static __attribute__((noinline)) T3R_AVX2 void convolve_w8(const t3r_convolution *layer, const t3r_block *block,
                                                           void *out, uint32_t out_pitch)
{
    convolve(layer, block, 1, out, out_pitch);
}

static __attribute__((noinline)) T3R_AVX2 void convolve_w16(const t3r_convolution *layer, const t3r_block *block,
                                                            void *out, uint32_t out_pitch)
{
    convolve(layer, block, 2, out, out_pitch);
}

/* Functions of their own: this one's stack lies under what plain C needs. */
void t3r_convolve_avx2(const t3r_convolution *layer, const t3r_block *block, void *out, uint32_t out_pitch)
{
    if (layer->activation_bits == 16) {
        t3r_convolve_c(layer, block, out, out_pitch);
    } else if (layer->weight_bits == 16) {
        convolve_w16(layer, block, out, out_pitch);
    } else {
        convolve_w8(layer, block, out, out_pitch);
    }
}

#else
typedef int t3r_no_convolve_avx2; /* a file may not be empty */
#endif
