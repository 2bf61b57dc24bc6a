#include "dot.h"

#include "core/fixed.h"

/* Four sums over one run of weights: 16-bit factors, 32-bit sums, which compilers know as one instruction (SSE2
 * pmaddwd, NEON smlal). */
#define DOT(WEIGHT)                                                                                                    \
    const int16_t *x0 = columns, *x1 = x0 + pitch, *x2 = x1 + pitch, *x3 = x2 + pitch;                                 \
    int32_t s0 = 0, s1 = 0, s2 = 0, s3 = 0;                                                                            \
    for (uint32_t i = 0; i < count; i++) {                                                                             \
        int16_t w = (int16_t)(WEIGHT);                                                                                 \
        s0 += x0[i] * w;                                                                                               \
        s1 += x1[i] * w;                                                                                               \
        s2 += x2[i] * w;                                                                                               \
        s3 += x3[i] * w;                                                                                               \
    }                                                                                                                  \
    sum[0] = s0, sum[1] = s1, sum[2] = s2, sum[3] = s3;

void t3r_dot_w8(const int16_t *columns, uint32_t pitch, const int8_t *weights, uint32_t count,
                int32_t sum[T3R_DOT_PIXELS])
{
    DOT(weights[i])
}

void t3r_dot_w16(const int16_t *columns, uint32_t pitch, const t3r_le16 *weights, uint32_t count,
                 int32_t sum[T3R_DOT_PIXELS])
{
    DOT(t3r_from_le16(weights[i]))
}

static void dot_high(const int16_t *columns, uint32_t pitch, const t3r_le16 *weights, uint32_t count,
                     int32_t sum[T3R_DOT_PIXELS])
{
    DOT(t3r_from_le16(weights[i]) >> 8)
}

static void dot_low(const int16_t *columns, uint32_t pitch, const t3r_le16 *weights, uint32_t count,
                    int32_t sum[T3R_DOT_PIXELS])
{
    DOT(t3r_from_le16(weights[i]) & 255)
}

void t3r_dot_w8_wide(const int16_t *columns, uint32_t pitch, const int8_t *weights, uint32_t count,
                     int64_t sum[T3R_DOT_PIXELS])
{
    sum[0] = sum[1] = sum[2] = sum[3] = 0;
    for (uint32_t at = 0; at < count; at += T3R_DOT_CHUNK) {
        int32_t part[T3R_DOT_PIXELS]; /* at most 256 x 2^15 x 2^7 = 2^30 */
        t3r_dot_w8(columns + at, pitch, weights + at, T3R_MIN(count - at, T3R_DOT_CHUNK), part);
        for (int i = 0; i < T3R_DOT_PIXELS; i++) {
            sum[i] += part[i];
        }
    }
}

/* weight = 256 high + low, low in 0..255: two sums that fit 32 bits, of 256 x 2^15 x 2^7 = 2^30 and 256 x 2^15 x 255 <
 * 2^31 at most. */
void t3r_dot_w16_wide(const int16_t *columns, uint32_t pitch, const t3r_le16 *weights, uint32_t count,
                      int64_t sum[T3R_DOT_PIXELS])
{
    sum[0] = sum[1] = sum[2] = sum[3] = 0;
    for (uint32_t at = 0; at < count; at += T3R_DOT_CHUNK) {
        uint32_t length = T3R_MIN(count - at, T3R_DOT_CHUNK);
        int32_t high[T3R_DOT_PIXELS], low[T3R_DOT_PIXELS];
        dot_high(columns + at, pitch, weights + at, length, high);
        dot_low(columns + at, pitch, weights + at, length, low);
        for (int i = 0; i < T3R_DOT_PIXELS; i++) {
            sum[i] += (int64_t)high[i] * 256 + low[i];
        }
    }
}
