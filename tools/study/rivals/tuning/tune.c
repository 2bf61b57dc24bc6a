/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/tuning/tune.h"

#include <stdlib.h>
#include <string.h>

#include "core/fixed.h"
#include "study/rivals/scores/choose.h"
#include "study/rivals/scores/score.h"
#include "study/rivals/tuning/neighbours.h"
#include "study/rivals/tuning/rounds.h"

bool tuned_model_of(tuned_model *tuned, const splat_model *whole)
{
    const size_t bytes = (size_t)whole->count * SPLAT_PARAMETERS * sizeof(double);
    *tuned = (tuned_model){{whole->count, whole->surfaces, malloc(bytes + 1)},
                           malloc(((size_t)whole->count + 1) * sizeof(uint32_t))};
    if (tuned->model.parameters == NULL || tuned->of == NULL) {
        return false;
    }
    memcpy(tuned->model.parameters, whole->parameters, bytes);
    for (uint32_t i = 0; i < whole->count; i++) {
        tuned->of[i] = i;
    }
    return true;
}

void tuned_model_free(tuned_model *tuned)
{
    splat_model_free(&tuned->model);
    free(tuned->of);
    *tuned = (tuned_model){0};
}

/* Scores the Gaussians of a model in the target views. */
static bool score_model(const splat_model *model, method_kind kind, uint32_t seed, const finetune_target *targets,
                        uint32_t count, double *score)
{
    splat_view views[T3R_MAX_VIEWS];
    uint32_t opened = 0;
    bool done = true;
    while (done && opened < count) {
        const uint32_t v = opened++;
        done = splat_view_open(&views[v], &targets[v].camera, model->count) && splat_view_project(&views[v], model);
    }
    done = done && score_of(kind, model, views, count, seed, score);
    for (uint32_t v = 0; v < opened; v++) {
        splat_view_close(&views[v]);
    }
    return done;
}

/* Keeps the `count` best Gaussians in their order. */
static bool keep_best(tuned_model *tuned, const double *score, uint32_t count)
{
    uint32_t *kept = malloc(((size_t)count + 1) * sizeof *kept);
    const bool done = kept != NULL && rival_choose(score, tuned->model.surfaces, tuned->model.count, count, kept);
    double *parameters = tuned->model.parameters;
    uint32_t surfaces = 0;
    for (uint32_t n = 0; n < count && done; n++) { /* kept[n] is at least n */
        surfaces += kept[n] < tuned->model.surfaces;
        memmove(&parameters[(size_t)n * SPLAT_PARAMETERS], &parameters[(size_t)kept[n] * SPLAT_PARAMETERS],
                SPLAT_PARAMETERS * sizeof(double));
        tuned->of[n] = tuned->of[kept[n]];
    }
    if (done) {
        tuned->model.count = count;
        tuned->model.surfaces = surfaces;
    }
    free(kept);
    return done;
}

static uint32_t iterations_of(const finetune_options *options)
{
    return options->iterations != 0 ? options->iterations : TUNE_ITERATIONS;
}

static const finetune_rates *rates_of(const finetune_options *options)
{
    return options->published_rates ? &finetune_rates_published : &finetune_rates_default;
}

bool tune_model(splat_model *model, const finetune_target *targets, uint32_t target_count,
                const finetune_options *options, t3r_threads *threads)
{
    return finetune(model, targets, target_count, iterations_of(options), rates_of(options), threads);
}

bool tune_rival(tuned_model *tuned, method_kind kind, const double *score, uint32_t budget, uint32_t seed,
                const finetune_target *targets, uint32_t target_count, const finetune_options *options,
                t3r_threads *threads)
{
    const uint32_t all = tuned->model.count, iterations = iterations_of(options);
    const uint32_t wanted = options->rounds != 0 ? options->rounds : rounds_published(kind);
    const uint32_t rounds = T3R_MIN(wanted, iterations);
    double *own = malloc(((size_t)all + 1) * sizeof *own); /* scores after the first round */
    bool done = own != NULL;
    for (uint32_t round = 0; round < rounds && done; round++) {
        const uint32_t left = rounds_left(kind, all, budget, round, rounds);
        const bool widens = left < tuned->model.count && !options->pruned_widths;
        done = round == 0 || score_model(&tuned->model, kind, seed, targets, target_count, own);
        done = done && keep_best(tuned, round == 0 ? score : own, left) &&
               (!widens || neighbour_widen(&tuned->model)) &&
               finetune(&tuned->model, targets, target_count, rounds_iterations(iterations, round, rounds),
                        rates_of(options), threads);
    }
    free(own);
    return done;
}
