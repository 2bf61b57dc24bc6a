/* SPDX-License-Identifier: Apache-2.0 */
/* A rival with fine-tuning: the Gaussians of an unpruned scene are pruned to a budget in rounds, and those that remain
 * are widened and fine-tuned after each round. */
#ifndef TRIM3R_TOOLS_RIVALS_TUNE_H
#define TRIM3R_TOOLS_RIVALS_TUNE_H

#include <stdbool.h>
#include <stdint.h>

#include "reconstruction/finetune_options.h"
#include "study/rivals/scores/kinds.h"
#include "study/rivals/tuning/finetune.h"

#define TUNE_ITERATIONS 200u /* default */

/* Gaussians of an unpruned scene as parameters. */
typedef struct tuned_model {
    splat_model model;
    uint32_t *of; /* indices in the unpruned scene, rising */
} tuned_model;

/* Copies all Gaussians of a model. Returns false if out of memory; call tuned_model_free() in any case. */
bool tuned_model_of(tuned_model *tuned, const splat_model *whole);
void tuned_model_free(tuned_model *tuned);

/* Prunes to `budget` Gaussians by the rival's score, and fine-tunes. score[]: of the unpruned model. Returns false if
 * out of memory. */
bool tune_rival(tuned_model *tuned, method_kind kind, const double *score, uint32_t budget, uint32_t seed,
                const finetune_target *targets, uint32_t target_count, const finetune_options *options,
                t3r_threads *threads);

/* Fine-tunes the model as it is. Returns false if out of memory. */
bool tune_model(splat_model *model, const finetune_target *targets, uint32_t target_count,
                const finetune_options *options, t3r_threads *threads);

#endif
