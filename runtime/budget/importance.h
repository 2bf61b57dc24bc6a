/* SPDX-License-Identifier: Apache-2.0 */
/* The allocation `given`: the caller chooses the points to retain by importance, and their density is counted (SPEC.md,
 * "Budget"). */
#ifndef T3R_IMPORTANCE_H
#define T3R_IMPORTANCE_H

#include <stddef.h>
#include <stdint.h>

#include "state/views.h"
#include "superclusters/superclusters.h"

/* One plane per context view, each width x height, owned by the caller and used within one call. */
typedef struct t3r_importance {
    const uint16_t *const *planes;
    uint32_t stride_bytes; /* between rows; even, at least 2 x width */
} t3r_importance;

/* Fills the key planes: the more important, the smaller. */
void t3r_importance_keys(const t3r_view *views, uint32_t count, const t3r_importance *importance);

/* Stores the share of points retained in each SuperCluster, log2 in Q10, -8579..0, in density_q10. */
void t3r_count_shares(const t3r_view *views, uint32_t count, t3r_cluster *clusters, uint32_t cluster_count);

/* Returns log2 of the share retained around a pixel with depth, Q10, -8579..0: counted in 9 x 9 pixels of its mask, or
 * its SuperCluster's share if that is far smaller. */
int32_t t3r_log_share_q10(const t3r_view *view, size_t pixel, const t3r_cluster *clusters);

#endif
