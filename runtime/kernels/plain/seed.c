#include "kernels/seed.h"

#include "core/fixed.h"

/* Returns floor((p - c)^2 / 4). The difference has 16 bits, so that a vector multiplies 16 bits to 32. */
static inline int32_t quarter_square(int16_t p, int16_t c)
{
    const int16_t e = (int16_t)(p - c);
    return (e * e) >> 2;
}

/* Returns the distance of point i with this centre added. */
static inline int32_t distance_with(const t3r_sample *sample, uint32_t i, const int16_t c[T3R_DIMENSIONS])
{
    int16_t *const *p = sample->feature_q11;
    const int32_t distance = quarter_square(p[0][i], c[0]) + quarter_square(p[1][i], c[1]) +
                             quarter_square(p[2][i], c[2]) + quarter_square(p[3][i], c[3]) +
                             quarter_square(p[4][i], c[4]) + quarter_square(p[5][i], c[5]);
    return T3R_MIN(distance, sample->distance_q20[i]);
}

uint64_t t3r_sample_potential_c(const t3r_sample *sample, uint32_t count, const int16_t centre_q11[T3R_DIMENSIONS])
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        sum += (uint32_t)distance_with(sample, i, centre_q11);
    }
    return sum;
}

uint64_t t3r_sample_approach_c(const t3r_sample *sample, uint32_t first, uint32_t end,
                               const int16_t centre_q11[T3R_DIMENSIONS])
{
    uint64_t sum = 0;
    for (uint32_t i = first; i < end; i++) {
        sample->distance_q20[i] = distance_with(sample, i, centre_q11);
        sum += (uint32_t)sample->distance_q20[i];
    }
    return sum;
}
