/* Stage superclusters over the pixels of the context views. */
#ifndef T3R_PIXEL_CLUSTERS_H
#define T3R_PIXEL_CLUSTERS_H

#include "trim3r.h"
#include "state/views.h"

/* Clusters the valid pixels of all views by x, y, z over the median depth and r, g, b over 255. Writes labels and
 * SuperClusters in the arena. Returns T3R_OK or T3R_ERR_CANCELLED. */
t3r_status t3r_cluster_pixels(t3r_runtime *rt, const t3r_view *views);

#endif
