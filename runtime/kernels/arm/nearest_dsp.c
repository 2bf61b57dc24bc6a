/* SPDX-License-Identifier: Apache-2.0 */
/* The nearest centre for a Cortex-M with sums of two products: compares all centres if there are few; otherwise plain
 * C's neighbours are faster. */
#include "variants.h"

#ifdef T3R_DSP

#include <arm_acle.h>
#include <stdbool.h>

#include "kernels/nearest.h"

enum { FEW = 96, PAIRS = T3R_DIMENSIONS / 2 };

/* Stored in place of the neighbours. */
typedef struct packed_centre {
    int32_t half_norm;
    int16x2_t less_pair[PAIRS]; /* of features, negative */
} packed_centre;

_Static_assert(sizeof(packed_centre) <= sizeof(uint16_t[T3R_NEIGHBOURS]), "they lie in their place");

static inline int16x2_t pair_of(int32_t low, int32_t high)
{
    return (int16x2_t)((uint32_t)low & 0xffff) | (int16x2_t)((uint32_t)high << 16);
}

void t3r_nearest_begin_dsp(const t3r_centres *centres, uint32_t first, uint32_t end, const t3r_neighbours *neighbours)
{
    if (centres->count > FEW) {
        t3r_nearest_begin_c(centres, first, end, neighbours);
        return;
    }
    packed_centre *packed = (packed_centre *)(void *)neighbours->index;
    for (uint32_t k = first; k < end; k++) {
        packed[k].half_norm = centres->half_norm[k];
        for (uint32_t d = 0; d < PAIRS; d++) {
            packed[k].less_pair[d] = pair_of(-centres->feature_q11[2 * d][k], -centres->feature_q11[2 * d + 1][k]);
        }
    }
}

/* Scores and their parts are below 2^31 in size (nearest.h). With intrinsics gcc 12 takes one load per word. */
static inline uint32_t nearest_of(const packed_centre *c, uint32_t count, const int16_t p[T3R_DIMENSIONS])
{
    const int16x2_t p01 = pair_of(p[0], p[1]), p23 = pair_of(p[2], p[3]), p45 = pair_of(p[4], p[5]);
    const packed_centre *end = c + count, *first = c, *behind = c;
    int32_t least = INT32_MAX;
    while (c != end) {
        __asm__("ldmia %[c]!, {r3, r4, r5, r6}\n\t"
                "smlad r3, %[p01], r4, r3\n\t"
                "smlad r3, %[p23], r5, r3\n\t"
                "smlad r3, %[p45], r6, r3\n\t"
                "cmp r3, %[least]\n\t"
                "itt lt\n\t"
                "movlt %[least], r3\n\t"
                "movlt %[behind], %[c]"
                : [c] "+r"(c), [least] "+r"(least), [behind] "+r"(behind)
                : [p01] "r"(p01), [p23] "r"(p23), [p45] "r"(p45)
                : "r3", "r4", "r5", "r6", "cc", "memory");
    }
    return (uint32_t)(behind - first) - 1;
}

void t3r_nearest_dsp(const t3r_centres *centres, const t3r_neighbours *neighbours, uint32_t points,
                     const int16_t (*feature_q11)[T3R_DIMENSIONS], uint16_t guess, uint16_t *nearest)
{
    if (centres->count > FEW) {
        t3r_nearest_c(centres, neighbours, points, feature_q11, guess, nearest);
        return;
    }
    for (uint32_t point = 0; point < points; point++) {
        nearest[point] = (uint16_t)nearest_of((const packed_centre *)(const void *)neighbours->index, centres->count,
                                              feature_q11[point]);
    }
}

#else
typedef int t3r_no_nearest_dsp; /* a file may not be empty */
#endif
