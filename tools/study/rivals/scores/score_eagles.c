/* SPDX-License-Identifier: Apache-2.0 */
/* EAGLES: Efficient Accelerated 3D Gaussians with Lightweight EncodingS. Girish, Gupta, Shrivastava, ECCV 2024
 * (arXiv:2312.04564), "Influence pruning": the influence of a Gaussian is the sum of its blending weights alpha_i T_i
 * over all pixels of the training views; Gaussians with the least influence are removed. */
#include <string.h>

#include "study/rivals/scores/score.h"

static void add_weights(void *user, const splat_row *row)
{
    double sum = 0, *score = user;
    for (uint32_t i = 0; i < row->columns; i++) {
        sum += (double)(row->alpha[i] * row->before[i]);
    }
    score[row->gaussian] += sum;
}

bool score_eagles(const splat_model *model, const splat_view *views, uint32_t view_count, double *score)
{
    memset(score, 0, model->count * sizeof *score);
    for (uint32_t v = 0; v < view_count; v++) {
        splat_view_walk(&views[v], add_weights, score);
    }
    return true;
}
