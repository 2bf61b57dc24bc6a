/* A single SuperCluster, for allocations and streams that use none. */
#ifndef T3R_ONE_CLUSTER_H
#define T3R_ONE_CLUSTER_H

#include <stdint.h>

#include "state/views.h"
#include "superclusters.h"

/* Assigns every pixel with depth to the cluster and returns the number of its points. The centre is unused, so it is
 * 0. */
uint32_t t3r_one_cluster(const t3r_view *views, uint32_t count, t3r_cluster *all);

#endif
