/* SPDX-License-Identifier: Apache-2.0 */
/* Rounds of pruning, as the rivals' programs have them: a part of the Gaussians is removed, the others are fine-tuned,
 * and those are scored anew. */
#ifndef TRIM3R_TOOLS_RIVALS_ROUNDS_H
#define TRIM3R_TOOLS_RIVALS_ROUNDS_H

#include <stdint.h>

#include "study/rivals/scores/kinds.h"

#define ROUNDS_MOST 16u

/* Returns the number of rounds that a rival's program has: EAGLES prunes five times (configs/efficient-3dgs.yaml), PUP
 * twice (scripts/full_pruning_pipeline.sh), EfficientGS three times (train.sh: --prune_way p4), LightGaussian once
 * (scripts/run_prune_finetune.sh). */
uint32_t rounds_published(method_kind kind);

/* Returns how many of `all` Gaussians remain after a round, of `rounds`; `budget` after the last. PUP's first round of
 * two removes 80 %. Otherwise each round keeps the same share. */
uint32_t rounds_left(method_kind kind, uint32_t all, uint32_t budget, uint32_t round, uint32_t rounds);

/* Returns the iterations of fine-tuning after a round: equal parts of `iterations`, the rest in the last round. */
uint32_t rounds_iterations(uint32_t iterations, uint32_t round, uint32_t rounds);

#endif
