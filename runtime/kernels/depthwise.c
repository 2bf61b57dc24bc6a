#include "depthwise.h"

#define DEPTHWISE(WEIGHT)                                                                                              \
    for (uint32_t c = 0; c < channels; c++) {                                                                          \
        sum[c] = 0;                                                                                                    \
    }                                                                                                                  \
    for (uint32_t t = 0; t < taps; t++, column += channels, weights += channels) {                                     \
        for (uint32_t c = 0; c < channels; c++) {                                                                      \
            sum[c] += column[c] * (WEIGHT);                                                                            \
        }                                                                                                              \
    }

void t3r_depthwise_w8(const int16_t *column, const int8_t *weights, uint32_t taps, uint32_t channels, int32_t *sum)
{
    DEPTHWISE(weights[c])
}

void t3r_depthwise_w16(const int16_t *column, const t3r_le16 *weights, uint32_t taps, uint32_t channels, int32_t *sum)
{
    DEPTHWISE(t3r_from_le16(weights[c]))
}

void t3r_depthwise_w16_wide(const int16_t *column, const t3r_le16 *weights, uint32_t taps, uint32_t channels,
                            int64_t *sum)
{
    DEPTHWISE(t3r_from_le16(weights[c])) /* a product is at most 2^30 */
}
