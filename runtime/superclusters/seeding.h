/* SPDX-License-Identifier: Apache-2.0 */
/* First centres of the K-means: k-means++ (Arthur and Vassilvitskii 2007) on a sample of the points, with the best of a
 * few draws for each centre. */
#ifndef T3R_SEEDING_H
#define T3R_SEEDING_H

#include "superclusters.h"

/* Places the settings' number of centres on points of the source. Kept centres (stays[]; NULL: none) are not changed,
 * and the others are drawn far from them. Without a valid point no centre is changed. Calls the host's step with 0 of
 * `total` between centres. Returns false if the host cancels. */
bool t3r_seed_centres(const t3r_point_source *source, const t3r_cluster_settings *settings, const bool *stays,
                      t3r_cluster *clusters, const t3r_sample *sample, const t3r_cluster_host *host, uint32_t total);

#endif
