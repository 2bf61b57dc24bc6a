/* SPDX-License-Identifier: Apache-2.0 */
/* The budget: which Z of the valid points are retained (GaussianTrim3R 3.1.2; SPEC.md, "Budget").
 *
 * All modes share one mechanism. Each point has a key, log2 of its blue-noise threshold over its wanted density.
 * A group of points (a SuperCluster, or all) retains the smallest keys up to its quota. So Z is met exactly,
 * a group's retained set grows with its quota, and another Z needs no new analysis. */
#ifndef T3R_BUDGET_H
#define T3R_BUDGET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/workers.h"
#include "kernels/kernels.h"
#include "state/views.h"
#include "superclusters/superclusters.h"
#include "trim3r.h"

typedef struct t3r_budget_settings {
    t3r_allocation allocate;
    uint32_t gaussians;    /* Z */
    uint32_t keep_percent; /* N of `paper` */
    uint32_t gamma_q8;
    uint32_t clusters;
    uint32_t seed;
    uint32_t first_view;    /* index by which the blue noise is shifted */
    bool pass_over_covered; /* the budget is small, so points of surfaces that another view covers are deferred */
} t3r_budget_settings;

#define T3R_KEY_DIGIT_BITS 4
#define T3R_KEY_DIGITS (1u << T3R_KEY_DIGIT_BITS)

/* Counts of a group of points. */
typedef struct t3r_group_count {
    union {
        uint32_t digit[T3R_KEY_DIGITS]; /* points by a digit of their keys */
        uint64_t expected_q16;          /* points expected by the densities */
    } of;
} t3r_group_count;

typedef struct t3r_budget_work {
    t3r_workers workers;
    t3r_group_count *counts; /* one per group and worker */
    const t3r_kernels *kernels;
} t3r_budget_work;

/* Whether the settings use this allocation; a constant false for an allocation left out of the build. */
static inline bool t3r_allocates(const t3r_budget_settings *settings, t3r_allocation allocation)
{
    const bool is_by_density = allocation == T3R_ALLOCATE_DENSITY || allocation == T3R_ALLOCATE_PIXEL;
    return (T3R_FEATURE_EXTRAS || is_by_density) && settings->allocate == allocation;
}

/* Returns the marks of points that are retained only after all others. */
static inline uint8_t t3r_deferring_marks(const t3r_budget_settings *settings)
{
    const uint8_t covered = settings->pass_over_covered ? T3R_MARK_COVERED : 0;
    return t3r_allocates(settings, T3R_ALLOCATE_GIVEN) ? 0 : (uint8_t)(T3R_MARK_DOUBTFUL | covered);
}

/* Whether a point is retained only after all others: doubtful points, and with pass_over_covered points that another
 * view covers. Heads don't widen other points' splats over them. Never with a given importance. */
static inline bool t3r_is_deferred(const t3r_view *view, size_t pixel, const t3r_budget_settings *settings)
{
    return (view->validity[pixel] & t3r_deferring_marks(settings)) != 0;
}

/* Whether Z is at most two thirds of the points that are neither doubtful nor covered by another view. */
bool t3r_is_sparse(const t3r_view *views, uint32_t count, uint32_t gaussians);

/* Computes quotas, thresholds and masks: exactly min(Z, valid points) bits are set, at most Z even if the cluster
 * counts are wrong. For `given` the key planes already hold the keys (importance.h). */
void t3r_allocate(const t3r_view *views, uint32_t count, const t3r_budget_settings *settings, t3r_cluster *clusters,
                  const t3r_budget_work *work);

/* Sets the mask of a view whose keys are in its plane: the points with keys below the threshold, and the first `ties`
 * at it. They are as dense as the threshold says. For one cluster. */
void t3r_retain_below(const t3r_view *view, const t3r_budget_settings *settings, uint32_t threshold, uint32_t ties,
                      t3r_cluster *clusters);

/* Returns log2 of the density of retained points around a pixel after the last allocation, Q10, at most 0: the points
 * are 2^(-density / 2) pixels apart. */
int32_t t3r_log_density_q10(const t3r_view *view, size_t pixel, const t3r_budget_settings *settings,
                            const t3r_cluster *clusters);

#endif
