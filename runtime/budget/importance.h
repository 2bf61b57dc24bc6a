/* The allocation `given`: the caller says which points are retained, and their density is counted
 * (SPEC.md, "Budget"). */
#ifndef T3R_IMPORTANCE_H
#define T3R_IMPORTANCE_H

#include <stddef.h>
#include <stdint.h>

#include "superclusters/superclusters.h"
#include "state/views.h"

/* One plane a context view, each width x height, as the caller lends it for a call. */
typedef struct t3r_importance {
    const uint16_t *const *planes;
    uint32_t stride_bytes; /* from row to row; even, at least 2 x width */
} t3r_importance;

/* The key planes: the more important, the smaller. */
void t3r_importance_keys(const t3r_view *views, uint32_t count, const t3r_importance *importance);

/* The share of points retained in each SuperCluster, log2 in Q10, -8579..0, into density_q10. */
void t3r_count_shares(const t3r_view *views, uint32_t count, t3r_cluster *clusters, uint32_t cluster_count);

/* Log2 of the share retained about a pixel with depth, Q10, -8579..0: counted from its mask in 9 x 9 pixels, and where
 * its SuperCluster has far less, that. */
int32_t t3r_log_share_q10(const t3r_view *view, size_t pixel, const t3r_cluster *clusters);

#endif
