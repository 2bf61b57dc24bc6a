/* SPDX-License-Identifier: Apache-2.0 */
#include "study/ablation/ablation.h"

#include <stddef.h>

typedef enum change {
    NOTHING,
    UNADAPTED,
    HIDDEN_MASK,
    SHUFFLED,
    ALLOCATION,
    SHUFFLED_PAPER,
    CLUSTERS,
    PAPER_PERCENT,
    UNREFINED,
    FLYING_OFF,
    REDUNDANCY_OFF,
    EXPOSURE_OFF
} change;

static const struct {
    const char *name;
    change what;
    uint32_t value;
} ablations[] = {
    {"full", NOTHING, 0},
    {"no-adaptation", UNADAPTED, 0},
    {"no-mask", HIDDEN_MASK, 0},
    {"random", ALLOCATION, T3R_ALLOCATE_RANDOM},
    {"random-clusters", SHUFFLED, 0},
    {"paper-random-clusters", SHUFFLED_PAPER, 0},
    {"uniform", ALLOCATION, T3R_ALLOCATE_UNIFORM},
    {"paper", ALLOCATION, T3R_ALLOCATE_PAPER},
    {"pixel", ALLOCATION, T3R_ALLOCATE_PIXEL},
    {"k-5", CLUSTERS, 5},
    {"k-25", CLUSTERS, 25},
    {"k-50", CLUSTERS, 50},
    {"k-100", CLUSTERS, 100},
    {"k-200", CLUSTERS, 200},
    {"k-300", CLUSTERS, 300},
    {"k-400", CLUSTERS, 400},
    {"n-5", PAPER_PERCENT, 5},
    {"n-10", PAPER_PERCENT, 10},
    {"n-15", PAPER_PERCENT, 15},
    {"n-20", PAPER_PERCENT, 20},
    {"no-refinement", UNREFINED, 0},
    {"no-flying", FLYING_OFF, 0},
    {"no-redundancy", REDUNDANCY_OFF, 0},
    {"no-exposure", EXPOSURE_OFF, 0},
};
enum { ABLATIONS = sizeof ablations / sizeof ablations[0] };
_Static_assert(ABLATIONS <= ABLATIONS_MOST, "ablation.h promises too few");

const char *ablation_name(uint32_t ablation)
{
    return ablation < ABLATIONS ? ablations[ablation].name : NULL;
}

bool ablation_applies(uint32_t ablation, const chosen_head *head, bool planar)
{
    switch (ablations[ablation].what) {
    case HIDDEN_MASK:
        return head->weights != NULL;
    case UNADAPTED:
        return !head->unadapted;
    case FLYING_OFF:
    case REDUNDANCY_OFF:
    case EXPOSURE_OFF:
        return !planar;
    default:
        return true;
    }
}

void ablation_apply(uint32_t ablation, reconstruction_options *settings)
{
    uint32_t value = ablations[ablation].value;
    switch (ablations[ablation].what) {
    case NOTHING:
        break;
    case UNADAPTED:
        settings->ablation.unadapted = 1;
        break;
    case HIDDEN_MASK:
        settings->hide_mask = true;
        break;
    case SHUFFLED_PAPER:
        settings->config.allocate = T3R_ALLOCATE_PAPER;
        settings->ablation.shuffle = 1;
        break;
    case SHUFFLED:
        settings->ablation.shuffle = 1;
        break;
    case ALLOCATION:
        settings->config.allocate = (t3r_allocation)value;
        break;
    case CLUSTERS:
        settings->config.clusters = value;
        break;
    case PAPER_PERCENT:
        settings->config.allocate = T3R_ALLOCATE_PAPER;
        settings->config.keep_percent = value;
        break;
    case UNREFINED:
        settings->config.refine = 0;
        break;
    case FLYING_OFF:
        settings->config.flying = 0;
        break;
    case REDUNDANCY_OFF:
        settings->config.redundancy = 0;
        break;
    case EXPOSURE_OFF:
        settings->config.exposure = 0;
        break;
    }
}
