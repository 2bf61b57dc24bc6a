/* SPDX-License-Identifier: Apache-2.0 */
/* Switches that remove a part of the method, so that tests and evaluations can measure its worth. They are not
 * settings: products don't need them, and each makes scenes worse. Builds without extras have none. */
#ifndef T3R_ABLATION_H
#define T3R_ABLATION_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

/* All 0: the whole method. */
typedef struct t3r_ablation {
    uint32_t shuffle;   /* 1 = SuperClusters exchange their textures at random */
    uint32_t unadapted; /* 1 = heads see every point as retained, so splats stay as small as pixels */
} t3r_ablation;

static inline bool t3r_shuffles(const t3r_ablation *ablation)
{
    return T3R_FEATURE_EXTRAS && ablation->shuffle != 0;
}

static inline bool t3r_is_unadapted(const t3r_ablation *ablation)
{
    return T3R_FEATURE_EXTRAS && ablation->unadapted != 0;
}

/* Applies from the next build on, also after t3r_reset() and t3r_attach(). NULL removes nothing. A shuffle happens in
 * the analysis, so a rebuild does not change it. T3R_ERR_UNSUPPORTED in builds without extras. */
t3r_status t3r_set_ablation(t3r_runtime *rt, const t3r_ablation *ablation);

#endif
