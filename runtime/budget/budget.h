/* The budget: which Z of the valid points are retained (GaussianTrim3R 3.1.2; SPEC.md, "Budget").
 *
 * One mechanism serves every mode. Each point has a key, log2 of its blue-noise threshold over its wanted density;
 * a group of points (a SuperCluster, or all) with a quota retains those with the smallest keys. So Z is met exactly,
 * a group's retained set grows with its quota, and another Z costs no new analysis. */
#ifndef T3R_BUDGET_H
#define T3R_BUDGET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/workers.h"
#include "kernels/kernels.h"
#include "superclusters/superclusters.h"
#include "trim3r.h"
#include "state/views.h"

typedef struct t3r_budget_settings {
    t3r_allocation allocation;
    uint32_t gaussians;    /* Z */
    uint32_t keep_percent; /* N of `paper` */
    uint32_t gamma_q8;
    uint32_t clusters;
    uint32_t seed;
    uint32_t shift;         /* of the blue noise: the number of the first view, so to speak */
    bool pass_over_covered; /* the budget is so small that points of surfaces seen twice are wanted once */
} t3r_budget_settings;

#define T3R_KEY_DIGIT_BITS 4
#define T3R_KEY_DIGITS (1u << T3R_KEY_DIGIT_BITS)

/* What is counted of a group of points. */
typedef struct t3r_group_count {
    union {
        uint32_t digit[T3R_KEY_DIGITS]; /* points by a digit of their keys */
        uint64_t expected_q16;          /* points expected by the densities */
    } of;
} t3r_group_count;

typedef struct t3r_budget_work {
    t3r_workers workers;
    t3r_group_count *counts; /* of each group, for each worker */
    const t3r_kernels *kernels;
} t3r_budget_work;

/* Whether the settings are those of an allocation. The compiler knows that they are not of one that is left out. */
static inline bool t3r_allocates(const t3r_budget_settings *settings, t3r_allocation allocation)
{
    const bool is_by_density = allocation == T3R_ALLOCATE_DENSITY || allocation == T3R_ALLOCATE_PIXEL;
    return (T3R_FEATURE_ALLOCATIONS || is_by_density) && settings->allocation == allocation;
}

/* The marks of points that are retained only once all others are. */
static inline uint8_t t3r_deferring_marks(const t3r_budget_settings *settings)
{
    const uint8_t covered = settings->pass_over_covered ? T3R_MARK_COVERED : 0;
    return t3r_allocates(settings, T3R_ALLOCATE_GIVEN) ? 0 : (uint8_t)(T3R_MARK_DOUBTFUL | covered);
}

/* Whether a point is retained only once all others are: the doubtful ones, and with pass_over_covered those that
 * another view covers. Heads let the splats of other points not grow over them. None when importance is given. */
static inline bool t3r_is_deferred(const t3r_view *view, size_t pixel, const t3r_budget_settings *settings)
{
    return (view->validity[pixel] & t3r_deferring_marks(settings)) != 0;
}

/* Whether Z is at most two thirds of the points that are neither doubtful nor covered by another view. */
bool t3r_is_sparse(const t3r_view *views, uint32_t count, uint32_t gaussians);

/* Blurs the texture planes with sigma 2 px (a 5 x 5 box twice), in place, by way of the key planes. */
void t3r_blur_texture(const t3r_kernels *kernels, const t3r_view *views, uint32_t count, const t3r_workers *workers);

/* Mean texture of every cluster (eq. 2), from the texture planes before they are blurred. */
void t3r_cluster_texture(const t3r_view *views, uint32_t count, t3r_cluster *clusters, uint32_t cluster_count);

/* Hands the textures of the clusters that have points round among them, every permutation alike likely. */
void t3r_shuffle_texture(t3r_cluster *clusters, uint32_t cluster_count, uint32_t seed);

/* Their order from the lowest texture up; whether they are in it, whatever the entries hold. */
void t3r_rank_clusters(t3r_cluster *clusters, uint32_t cluster_count);
bool t3r_are_ranked(const t3r_cluster *clusters, uint32_t cluster_count);

/* The keys of all pixels, of which t3r_allocate() retains the smallest; log2 of the density that a texture asks for, up
 * to a constant, Q10: key = T3R_KEY_ZERO + log2 of the threshold - wanted but for sure and deferred points. */
void t3r_budget_keys(const t3r_view *views, uint32_t count, const t3r_budget_settings *settings,
                     const t3r_budget_work *work);
int32_t t3r_log_wanted_q10(uint16_t texture_q4, const t3r_budget_settings *settings);

/* Quotas, thresholds and masks: exactly min(Z, valid points) bits set, and at most Z whatever the clusters say. For
 * `given` the key planes hold the keys already (importance.h). */
void t3r_allocate(const t3r_view *views, uint32_t count, const t3r_budget_settings *settings, t3r_cluster *clusters,
                  const t3r_budget_work *work);

/* Log2 of the density of retained points about a pixel under the allocation made last, Q10, at most 0: they are
 * 2^(-density / 2) pixels apart. */
int32_t t3r_log_density_q10(const t3r_view *view, size_t pixel, const t3r_budget_settings *settings,
                            const t3r_cluster *clusters);

#endif
