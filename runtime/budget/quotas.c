#include "quotas.h"

#include "budget_keys.h"
#include "core/fixed.h"
#include "core/logarithm.h"

/* Returns the number of a cluster's points that are not deferred. */
static inline uint32_t open_points(const t3r_cluster *cluster)
{
    return cluster->points - T3R_MIN(cluster->deferred, cluster->points);
}

/* Bound of sums of weights, which are points times a factor. Larger sums are clamped. */
#define WEIGHTS_MOST (((uint64_t)1 << 39) - 1)

static uint64_t add_weight(uint64_t sum, uint64_t weight)
{
    return T3R_MIN(sum + T3R_MIN(weight, WEIGHTS_MOST), WEIGHTS_MOST);
}

/* Shares `budget`, at most 2^24, among the clusters in proportion to weight[k]. Cumulative rounding makes the sum exact
 * and each quota one of the two integers next to its share. The sum is at most the budget for any weights. */
static void share_out(t3r_cluster *clusters, uint32_t count, const uint64_t *weight, uint64_t budget)
{
    uint64_t total = 0, running = 0, given = 0;
    for (uint32_t k = 0; k < count; k++) {
        total = add_weight(total, weight[k]);
    }
    for (uint32_t k = 0; k < count && total > 0; k++) {
        if (weight[k] > 0) {
            running = add_weight(running, weight[k]);
            uint64_t due = running * budget / total; /* `running` is at most `total`, and below 2^39 */
            clusters[k].quota = (uint32_t)(due - given);
            given = due;
        }
    }
}

/* Sets the quotas of `density`: in proportion to |SC| x Texture(SC)^gamma, at most a cluster's points. A cluster whose
 * share would exceed its points gets them all, and the rest is shared again: at most K rounds, a few in practice. */
static void quotas_by_density(t3r_cluster *clusters, uint32_t count, const t3r_budget_settings *settings,
                              uint64_t budget)
{
    uint64_t weight[T3R_MAX_CLUSTERS]; /* points x factor: below 2^28 x 2^10, 2^38 in sum */
    uint32_t factor_q10[T3R_MAX_CLUSTERS];
    int32_t most = 0;
    for (uint32_t k = 0; k < count; k++) {
        most = T3R_MAX(most, t3r_log_wanted_q10((uint16_t)clusters[k].texture_q4, settings));
    }
    for (uint32_t k = 0; k < count; k++) {
        int32_t below = t3r_log_wanted_q10((uint16_t)clusters[k].texture_q4, settings) - most;
        factor_q10[k] = below <= -(10 << 10) ? 1 : t3r_exp2_q16(below * 64) >> 6; /* at least 1 here, too */
        weight[k] = (uint64_t)open_points(&clusters[k]) * factor_q10[k];
    }
    for (uint32_t round = 0; round < count; round++) {
        uint64_t total = 0, taken = 0;
        for (uint32_t k = 0; k < count; k++) {
            total += weight[k];
        }
        for (uint32_t k = 0; k < count; k++) {
            /* weight budget / total >= points, divided by points */
            if (weight[k] > 0 && factor_q10[k] * budget >= total) {
                clusters[k].quota = open_points(&clusters[k]);
                taken += open_points(&clusters[k]);
                weight[k] = 0;
            }
        }
        if (taken == 0) {
            break;
        }
        budget -= T3R_MIN(taken, budget);
    }
    share_out(clusters, count, weight, budget);
}

/* Sets the quotas of `paper`: from the lowest texture up each cluster keeps N % of its points until Z is met. The last
 * one is cut so that Z is exact. If Z is below N % of all, N becomes Z / valid for all. */
static void quotas_by_paper(t3r_cluster *clusters, uint32_t count, const t3r_budget_settings *settings, uint64_t budget,
                            uint64_t valid)
{
    uint64_t left = valid;
    for (uint32_t k = 0; k < count; k++) {
        clusters[k].quota = open_points(&clusters[k]);
    }
    for (uint32_t i = 0; i < count && left > budget; i++) {
        t3r_cluster *cluster = &clusters[clusters[i].order];
        uint64_t kept = ((uint64_t)open_points(cluster) * settings->keep_percent + 50) / 100;
        uint64_t dropped = T3R_MIN(open_points(cluster) - kept, left - budget);
        cluster->quota = (uint32_t)(open_points(cluster) - dropped);
        left -= dropped;
    }
    if (left > budget) {
        uint64_t weight[T3R_MAX_CLUSTERS];
        for (uint32_t k = 0; k < count; k++) {
            weight[k] = open_points(&clusters[k]);
        }
        share_out(clusters, count, weight, budget);
    }
}

/* Limits the sum of all groups' quotas to Z, because the scene has no room for more. */
static void hold_quotas(t3r_cluster *clusters, uint32_t groups, uint32_t most)
{
    for (uint32_t g = 0; g < groups; g++) {
        clusters[g].quota = T3R_MIN(clusters[g].quota, most);
        most -= clusters[g].quota;
    }
}

void t3r_set_quotas(t3r_cluster *clusters, const t3r_budget_settings *settings)
{
    uint64_t valid = 0;
    for (uint32_t k = 0; k < settings->clusters; k++) {
        valid += open_points(&clusters[k]);
        clusters[k].quota = 0;
    }
    uint64_t budget = T3R_MIN(settings->gaussians, valid);
    if (t3r_allocates(settings, T3R_ALLOCATE_DENSITY)) {
        quotas_by_density(clusters, settings->clusters, settings, budget);
    } else if (t3r_allocates(settings, T3R_ALLOCATE_PAPER)) {
        quotas_by_paper(clusters, settings->clusters, settings, budget, valid);
    } else {
        clusters[0].quota = (uint32_t)budget;
    }
    t3r_cluster *deferred = &clusters[settings->clusters];
    deferred->quota = (uint32_t)T3R_MIN(settings->gaussians - budget, deferred->points);
    hold_quotas(clusters, settings->clusters + 1, settings->gaussians);
}
