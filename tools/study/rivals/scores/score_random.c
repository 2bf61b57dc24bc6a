/* SPDX-License-Identifier: Apache-2.0 */
/* Random: the lower bound in every paper on pruning. */
#include "study/rivals/scores/score.h"

/* splitmix64 of the seed and the index */
bool score_random(const splat_model *model, uint32_t seed, double *score)
{
    for (uint32_t i = 0; i < model->count; i++) {
        uint64_t z = ((uint64_t)seed << 32) + (i + UINT64_C(1)) * UINT64_C(0x9e3779b97f4a7c15);
        z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
        z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
        score[i] = (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
    return true;
}
