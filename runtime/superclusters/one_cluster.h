/* A single SuperCluster, for allocations and streams that know none. */
#ifndef T3R_ONE_CLUSTER_H
#define T3R_ONE_CLUSTER_H

#include <stdint.h>

#include "state/views.h"
#include "superclusters.h"

/* Every pixel with depth becomes its point. Nobody asks for its centre, which is 0. Returns how many points it has. */
uint32_t t3r_one_cluster(const t3r_view *views, uint32_t count, t3r_cluster *all);

#endif
