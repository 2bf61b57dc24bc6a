/* SPDX-License-Identifier: Apache-2.0 */
/* Results that a build reuses from the last one (t3r_config.warm): recorded after an analysis, cleared when a build
 * fails. */
#ifndef T3R_REUSE_H
#define T3R_REUSE_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

typedef struct t3r_reuse {
    uint32_t views; /* bit v: depth, marks and the kept texture of view v belong to its current planes */
    uint32_t
        centres; /* 1 = the kept SuperClusters belong to the scene's frame; 0 = the next build starts from scratch */
} t3r_reuse;

/* Whether view v needs no new analysis. */
bool t3r_is_reused(const t3r_runtime *rt, uint32_t v);

/* Records that view v gets new planes. */
void t3r_reuse_no_view(t3r_runtime *rt, uint32_t v);

/* Makes the next build start from scratch. */
void t3r_reuse_nothing(t3r_runtime *rt);

/* Records that the views in the arena are analysed, so that the next build may follow. Call before anything overwrites
 * the SuperClusters. */
void t3r_reuse_all(t3r_runtime *rt);

/* Returns the plane that keeps the unblurred texture of view v. */
uint16_t *t3r_kept_texture(const t3r_runtime *rt, uint32_t v);

#endif
