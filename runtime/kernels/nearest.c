#include "nearest.h"

#define LANES T3R_NEAREST_BLOCK

void t3r_nearest(const t3r_centres *centres, uint32_t points, const int16_t (*feature_q11)[T3R_DIMENSIONS],
                 uint16_t *nearest)
{
    for (uint32_t point = 0; point < points; point++) {
        const int16_t *p = feature_q11[point];
        const int16_t p0 = p[0], p1 = p[1], p2 = p[2], p3 = p[3], p4 = p[4], p5 = p[5];
        int32_t best[LANES], block[LANES];
        for (uint32_t lane = 0; lane < LANES; lane++) {
            best[lane] = INT32_MAX;
            block[lane] = 0;
        }
        for (uint32_t k = 0; k < centres->count; k += LANES) {
            for (uint32_t lane = 0; lane < LANES; lane++) {
                int32_t score = centres->half_norm[k + lane] -
                                (p0 * centres->feature_q11[0][k + lane] + p1 * centres->feature_q11[1][k + lane] +
                                 p2 * centres->feature_q11[2][k + lane] + p3 * centres->feature_q11[3][k + lane] +
                                 p4 * centres->feature_q11[4][k + lane] + p5 * centres->feature_q11[5][k + lane]);
                block[lane] = score < best[lane] ? (int32_t)k : block[lane];
                best[lane] = score < best[lane] ? score : best[lane];
            }
        }
        int32_t least = best[0], index = block[0];
        for (uint32_t lane = 1; lane < LANES; lane++) {
            int32_t candidate = block[lane] + (int32_t)lane;
            if (best[lane] < least || (best[lane] == least && candidate < index)) {
                least = best[lane];
                index = candidate;
            }
        }
        nearest[point] = (uint16_t)index;
    }
}
