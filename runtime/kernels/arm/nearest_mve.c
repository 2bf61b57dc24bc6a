/* SPDX-License-Identifier: Apache-2.0 */
/* The nearest centre by comparing all of them, four at a time, in vectors of Helium. */
#include "variants.h"

#ifdef T3R_MVE

#include <arm_mve.h>
#include <stdbool.h>

#include "kernels/nearest.h"

enum { FOUR = 4 };

/* Four centres, stored in place of the neighbours; after the last, padding centres that never win. */
typedef struct four_centres {
    int32_t half_norm[FOUR];
    int16_t less_feature_q11[T3R_DIMENSIONS][FOUR]; /* negative */
} four_centres;

_Static_assert(sizeof(four_centres) <= sizeof(uint16_t[FOUR][T3R_NEIGHBOURS]), "they lie in their place");
_Static_assert(T3R_CENTRE_GROUP % FOUR == 0, "whole vectors");

void t3r_nearest_begin_mve(const t3r_centres *centres, uint32_t first, uint32_t end, const t3r_neighbours *neighbours)
{
    four_centres *packed = (four_centres *)(void *)neighbours->index;
    for (uint32_t k = first; k < (end + FOUR - 1) / FOUR * FOUR; k++) {
        const bool is_centre = k < centres->count;
        packed[k / FOUR].half_norm[k % FOUR] = is_centre ? centres->half_norm[k] : INT32_MAX;
        for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
            packed[k / FOUR].less_feature_q11[d][k % FOUR] = (int16_t)(is_centre ? -centres->feature_q11[d][k] : 0);
        }
    }
}

static uint16_t nearest_of(const t3r_neighbours *packed, uint32_t count, const int16_t p[T3R_DIMENSIONS])
{
    const four_centres *c = (const four_centres *)(const void *)packed->index;
    const int32_t p0 = p[0], p1 = p[1], p2 = p[2], p3 = p[3], p4 = p[4], p5 = p[5];
    uint32_t predicate, groups = (count + FOUR - 1) / FOUR;
    int32x4_t here = vreinterpretq_s32_u32(vidupq_n_u32(0, 1)), first = here, least = vdupq_n_s32(INT32_MAX);
    /* Scores and their parts are below 2^31 in size (nearest.h). A lane keeps the earlier of equals. With intrinsics
     * gcc 12 moves loads before all sums and runs out of registers. */
    __asm__("vmrs %[predicate], p0\n\t" /* compilers have no common name for it */
            "dls lr, %[groups]\n\t"
            "mov %[groups], #4\n"
            "1:\n\t"
            "vldrw.u32 q0, [%[c]], #16\n\t"
            "vldrh.s32 q1, [%[c]], #8\n\t"
            "vmla.s32 q0, q1, %[p0]\n\t"
            "vldrh.s32 q2, [%[c]], #8\n\t"
            "vmla.s32 q0, q2, %[p1]\n\t"
            "vldrh.s32 q1, [%[c]], #8\n\t"
            "vmla.s32 q0, q1, %[p2]\n\t"
            "vldrh.s32 q2, [%[c]], #8\n\t"
            "vmla.s32 q0, q2, %[p3]\n\t"
            "vldrh.s32 q1, [%[c]], #8\n\t"
            "vmla.s32 q0, q1, %[p4]\n\t"
            "vldrh.s32 q2, [%[c]], #8\n\t"
            "vmla.s32 q0, q2, %[p5]\n\t"
            "vptt.s32 gt, %q[least], q0\n\t"
            "vmovt %q[least], q0\n\t"
            "vmovt %q[first], %q[here]\n\t"
            "vadd.i32 %q[here], %q[here], %[groups]\n\t"
            "le lr, 1b\n\t"
            "vmsr p0, %[predicate]"
            : [predicate] "=&r"(predicate), [c] "+l"(c), [groups] "+r"(groups), [least] "+w"(least),
              [first] "+w"(first), [here] "+w"(here)
            : [p0] "r"(p0), [p1] "r"(p1), [p2] "r"(p2), [p3] "r"(p3), [p4] "r"(p4), [p5] "r"(p5)
            : "lr", "q0", "q1", "q2", "memory");
    const int32_t score = vminvq_s32(INT32_MAX, least);
    return (uint16_t)vminvq_p_s32(INT32_MAX, first, vcmpeqq_n_s32(least, score));
}

void t3r_nearest_mve(const t3r_centres *centres, const t3r_neighbours *neighbours, uint32_t points,
                     const int16_t (*feature_q11)[T3R_DIMENSIONS], uint16_t guess, uint16_t *nearest)
{
    (void)guess;
    for (uint32_t point = 0; point < points; point++) {
        nearest[point] = nearest_of(neighbours, centres->count, feature_q11[point]);
    }
}

#else
typedef int t3r_no_nearest_mve; /* a file may not be empty */
#endif
