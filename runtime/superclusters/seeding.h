/* The first centres of the K-means: k-means++ (Arthur and Vassilvitskii 2007) on a sample of the points, the best of a
 * few draws a centre. */
#ifndef T3R_SEEDING_H
#define T3R_SEEDING_H

#include "superclusters.h"

/* Places the settings' number of centres on points of the source. Those that stay are left as they are, and the others
 * are drawn far from them (NULL: none stays). Without a valid point all are left as they are. The host's step, 0 of
 * `total`, is called between centres. False: it wants no more. */
bool t3r_seed_centres(const t3r_point_source *source, const t3r_cluster_settings *settings, const bool *stays,
                      t3r_cluster *clusters, const t3r_sample *sample, const t3r_cluster_host *host, uint32_t total);

#endif
