/* A layer of 8-bit weights at four pixels and four outputs at a time: 64 taps a step. */
#include "variants.h"

#ifdef T3R_X86

#include "requantize.h"

#define TAPS 64u /* of a step */
#define PIXELS 4u
#define FEW 32u /* taps for which adding up a step costs more than shorter vectors do */

/* Modulo 2^32. Without optimisation an intrinsic would take stack for each operand. */
#define ADDED(a, b) ((__m512i)((__v16su)(a) + (__v16su)(b)))

/* The numbers where `there` has ones, else zeros. Nothing else is read. */
static inline T3R_VNNI __m512i load(const void *from, __mmask64 there)
{
    return _mm512_maskz_loadu_epi8(there, from);
}

static inline T3R_VNNI __mmask64 first_lanes(uint32_t count)
{
    return count >= TAPS ? ~(__mmask64)0 : ((__mmask64)1 << count) - 1;
}

/* Sums of neighbours: numbers of both in turn. */
static inline T3R_VNNI __m512i paired(__m512i a, __m512i b)
{
    return ADDED(_mm512_unpacklo_epi32(a, b), _mm512_unpackhi_epi32(a, b));
}

/* Each quarter's sums of four outputs, in their order. */
static inline T3R_VNNI __m512i in_quarters(const __m512i s[T3R_FOUR])
{
    const __m512i a = paired(s[0], s[1]), b = paired(s[2], s[3]);
    return ADDED(_mm512_unpacklo_epi64(a, b), _mm512_unpackhi_epi64(a, b));
}

/* Quarters 0 + 2 and 1 + 3 of a, then of b. */
static inline T3R_VNNI __m512i halved(__m512i a, __m512i b)
{
    return ADDED(_mm512_shuffle_i32x4(a, b, 0x44), _mm512_shuffle_i32x4(a, b, 0xee));
}

/* Each pixel's quarters added up, in the quarter of the pixel's number. */
static inline T3R_VNNI __m512i added_up(const __m512i pixel[PIXELS])
{
    const __m512i a = halved(pixel[0], pixel[1]), b = halved(pixel[2], pixel[3]);
    return ADDED(_mm512_shuffle_i32x4(a, b, 0x88), _mm512_shuffle_i32x4(a, b, 0xdd));
}

/* The instruction takes one factor without sign: activations + 128. So every sum is 128 times its weights' sum too
 * large, and this is what to take from it; in every quarter. */
static inline T3R_VNNI __m512i excess_of(const uint8_t *const weights[T3R_FOUR], uint32_t taps)
{
    const __m512i offset = _mm512_set1_epi8(-128);
    __m512i s[T3R_FOUR];
    for (uint32_t o = 0; o < T3R_FOUR; o++) {
        s[o] = _mm512_setzero_si512();
        for (uint32_t tap = 0; tap < taps; tap += TAPS) {
            s[o] = _mm512_dpbusd_epi32(s[o], offset, load(weights[o] + tap, first_lanes(taps - tap)));
        }
    }
    const __m512i quarters = in_quarters(s);
    const __m512i all[PIXELS] = {quarters, quarters, quarters, quarters};
    return added_up(all);
}

/* Adds the products of a run's taps, up to 64 of them, at a pixel. */
static inline T3R_VNNI void add_step(__m512i s[T3R_FOUR], const uint8_t *x, __mmask64 there,
                                     const __m512i weights[T3R_FOUR])
{
    const __m512i unsigned_x = _mm512_xor_si512(load(x, there), _mm512_set1_epi8(-128));
    s[0] = _mm512_dpbusd_epi32(s[0], unsigned_x, weights[0]);
    s[1] = _mm512_dpbusd_epi32(s[1], unsigned_x, weights[1]);
    s[2] = _mm512_dpbusd_epi32(s[2], unsigned_x, weights[2]);
    s[3] = _mm512_dpbusd_epi32(s[3], unsigned_x, weights[3]);
}

/* Four outputs at four pixels. Where a run has ended, weights are zero. Sums are modulo 2^32. */
static inline T3R_VNNI __m512i dot(const t3r_block *block, const uint32_t pixel[PIXELS],
                                   const uint8_t *const weights[T3R_FOUR])
{
    const size_t p0 = (size_t)pixel[0] * block->step, p1 = (size_t)pixel[1] * block->step;
    const size_t p2 = (size_t)pixel[2] * block->step, p3 = (size_t)pixel[3] * block->step;
    const uint32_t steps = (block->run + TAPS - 1) / TAPS;
    const __mmask64 last = first_lanes(block->run - (steps - 1) * TAPS);
    const uint8_t *w0 = weights[0], *w1 = weights[1], *w2 = weights[2], *w3 = weights[3];
    __m512i s[PIXELS][T3R_FOUR];
    for (uint32_t p = 0; p < PIXELS; p++) {
        for (uint32_t o = 0; o < T3R_FOUR; o++) {
            s[p][o] = _mm512_setzero_si512();
        }
    }
    uint32_t row = 0, step = 0, tap = 0;
    for (uint32_t i = 0; i < block->rows * steps; i++) {
        const bool ends = step + 1 == steps;
        const __mmask64 there = ends ? last : ~(__mmask64)0;
        const uint8_t *x = block->row[row] + block->first + step * TAPS;
        const __m512i w[T3R_FOUR] = {load(w0 + tap, there), load(w1 + tap, there), load(w2 + tap, there),
                                     load(w3 + tap, there)};
        add_step(s[0], x + p0, there, w);
        add_step(s[1], x + p1, there, w);
        add_step(s[2], x + p2, there, w);
        add_step(s[3], x + p3, there, w);
        step = ends ? 0 : step + 1;
        row += ends;
        tap = row * block->run + step * TAPS;
    }
    const __m512i quarters[PIXELS] = {in_quarters(s[0]), in_quarters(s[1]), in_quarters(s[2]), in_quarters(s[3])};
    return added_up(quarters);
}

static __attribute__((noinline)) T3R_VNNI void convolve_four(const t3r_convolution *layer, const t3r_block *block,
                                                             uint32_t first, void *out, uint32_t out_pitch)
{
    const uint32_t count = layer->outputs - first < T3R_FOUR ? layer->outputs - first : T3R_FOUR;
    const t3r_x86_scaling scaling = t3r_x86_scaling_of(layer, first);
    const uint8_t *weights[T3R_FOUR];
    for (uint32_t o = 0; o < T3R_FOUR; o++) { /* behind the last output, it again */
        weights[o] = layer->weights + (size_t)(first + (o < count ? o : count - 1)) * layer->taps;
    }
    const __m512i excess = excess_of(weights, layer->taps);
    for (uint32_t i = 0; i < block->pixels; i += PIXELS) {
        uint32_t pixel[PIXELS];
        for (uint32_t p = 0; p < PIXELS; p++) { /* behind the last, it again */
            pixel[p] = i + p < block->pixels ? i + p : block->pixels - 1;
        }
        const __m512i sum = _mm512_sub_epi32(dot(block, pixel, weights), excess);
        const __m256i lower = t3r_x86_scaled(_mm512_castsi512_si256(sum), &scaling, layer->zero);
        const __m256i upper = t3r_x86_scaled(_mm512_extracti64x4_epi64(sum, 1), &scaling, layer->zero);
        const __m128i four[PIXELS] = {_mm256_castsi256_si128(lower), _mm256_extracti128_si256(lower, 1),
                                      _mm256_castsi256_si128(upper), _mm256_extracti128_si256(upper, 1)};
        for (uint32_t p = 0; p < PIXELS; p++) {
            t3r_x86_write(four[p], layer->output_bits, count, out, (size_t)pixel[p] * out_pitch + first);
        }
    }
}

T3R_VNNI void t3r_convolve_vnni(const t3r_convolution *layer, const t3r_block *block, void *out, uint32_t out_pitch)
{
    if (layer->activation_bits == 16 || layer->weight_bits == 16 || layer->taps <= FEW) {
        t3r_convolve_avx2(layer, block, out, out_pitch);
        return;
    }
    for (uint32_t first = 0; first < layer->outputs; first += T3R_FOUR) {
        convolve_four(layer, block, first, out, out_pitch);
    }
}

#else
typedef int t3r_no_convolve_vnni; /* a file may not be empty */
#endif
