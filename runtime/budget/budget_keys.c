/* SPDX-License-Identifier: Apache-2.0 */
#include "budget_keys.h"

#include "blue_noise.h"
#include "core/fixed.h"
#include "core/logarithm.h"
#include "core/memory.h"

/* Rows of a view whose keys are computed. */
typedef struct key_job {
    const t3r_kernels *kernels;
    const t3r_view *view;
    uint32_t number; /* index of the view */
    const t3r_budget_settings *settings;
} key_job;

static bool follows_texture(const t3r_budget_settings *settings)
{
    return !T3R_FEATURE_EXTRAS || t3r_allocates(settings, T3R_ALLOCATE_DENSITY) ||
           t3r_allocates(settings, T3R_ALLOCATE_PIXEL);
}

int32_t t3r_log_wanted_q10(uint16_t texture_q4, const t3r_budget_settings *settings)
{
    if (!follows_texture(settings)) {
        return 0;
    }
    int64_t log_q16 = t3r_log2_q16((uint32_t)texture_q4 + T3R_TEXTURE_FLOOR_Q4);
    return (int32_t)t3r_round_shift64(log_q16 * settings->gamma_q8, 14);
}

void t3r_find_wanted(const t3r_budget_settings *settings, const t3r_kernels *kernels, const uint16_t *texture_q4,
                     uint32_t count, uint16_t *wanted_q10)
{
    if (follows_texture(settings)) {
        kernels->wanted_row(texture_q4, count, settings->gamma_q8, wanted_q10);
    } else {
        memset(wanted_q10, 0, count * sizeof *wanted_q10);
    }
}

/* Finds the blue-noise ranks of a row of the view. Each view has the map shifted, so that two views of a surface
 * complement each other. */
static void find_ranks(uint32_t view, uint32_t y, uint16_t rank[T3R_BLUE_NOISE_SIDE])
{
    const uint32_t row = (y + 23 * view) % T3R_BLUE_NOISE_SIDE;
    for (uint32_t x = 0; x < T3R_BLUE_NOISE_SIDE; x++) {
        rank[x] = (uint16_t)t3r_blue_noise(row, (x + 46 * view) % T3R_BLUE_NOISE_SIDE);
    }
}

/* Raises the keys of deferred points. Doubtful ones get the upper half, so that they come last. */
static void defer_row(const key_job *job, size_t at, uint32_t count)
{
    const uint8_t deferring = t3r_deferring_marks(job->settings);
    const uint8_t *validity = job->view->validity + at;
    uint16_t *key = job->view->key + at;
    for (uint32_t x = 0; x < count; x++) {
        const uint16_t deferred = (uint16_t)((key[x] >> 1) | (t3r_is_doubtful(validity[x]) ? 0x8000u : 0));
        key[x] = (validity[x] & deferring) != 0 ? deferred : key[x];
    }
}

/* Computes the keys of rows. Thresholds are blue noise, whose 4,096 ranks are split by white noise, or white noise
 * alone. */
static void key_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const key_job *job = context;
    const t3r_view *view = job->view;
    const uint32_t number = job->settings->first_view + job->number, seed = t3r_mix32(job->settings->seed);
    const bool is_white = t3r_allocates(job->settings, T3R_ALLOCATE_RANDOM);
    for (uint32_t y = begin; y < end; y++) {
        uint16_t rank[T3R_BLUE_NOISE_SIDE], wanted_q10[T3R_KEY_RUN];
        find_ranks(number, y, rank);
        const size_t at = (size_t)y * view->width;
        for (uint32_t x = 0; x < view->width; x += T3R_KEY_RUN) {
            const uint32_t count = T3R_MIN(T3R_KEY_RUN, view->width - x);
            t3r_find_wanted(job->settings, job->kernels, view->texture + at + x, count, wanted_q10);
            job->kernels->key_row((number << 26) ^ (y << 13) ^ x, seed, is_white ? NULL : rank, wanted_q10, count,
                                  view->key + at + x);
        }
        defer_row(job, at, view->width);
    }
}

void t3r_budget_keys(const t3r_view *views, uint32_t count, const t3r_budget_settings *settings,
                     const t3r_budget_work *work)
{
    for (uint32_t v = 0; v < count; v++) {
        key_job job = {.kernels = work->kernels, .view = &views[v], .number = v, .settings = settings};
        t3r_run_rows(&work->workers, views[v].height, key_rows, &job);
    }
}
