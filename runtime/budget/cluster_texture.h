/* Texture as the budget takes it: blurred, as the mean of a SuperCluster, and as an order of SuperClusters. */
#ifndef T3R_CLUSTER_TEXTURE_H
#define T3R_CLUSTER_TEXTURE_H

#include "core/workers.h"
#include "kernels/kernels.h"
#include "state/views.h"
#include "superclusters/superclusters.h"

/* Blurs the texture planes with sigma 2 px (a 5 x 5 box twice), in place, by way of the key planes. */
void t3r_blur_texture(const t3r_kernels *kernels, const t3r_view *views, uint32_t count, const t3r_workers *workers);

/* Mean texture of every cluster (eq. 2), from the texture planes before they are blurred. */
void t3r_cluster_texture(const t3r_view *views, uint32_t count, t3r_cluster *clusters, uint32_t cluster_count);

/* Hands the textures of the clusters that have points round among them, every permutation alike likely. */
void t3r_shuffle_texture(t3r_cluster *clusters, uint32_t cluster_count, uint32_t seed);

/* Their order from the lowest texture up; whether they are in it, whatever the entries hold. */
void t3r_rank_clusters(t3r_cluster *clusters, uint32_t cluster_count);
bool t3r_are_ranked(const t3r_cluster *clusters, uint32_t cluster_count);

#endif
