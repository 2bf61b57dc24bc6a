/* SPDX-License-Identifier: Apache-2.0 */
/* Texture for the budget: blurred, as the mean of a SuperCluster, and as an order of SuperClusters. */
#ifndef T3R_CLUSTER_TEXTURE_H
#define T3R_CLUSTER_TEXTURE_H

#include "core/workers.h"
#include "kernels/kernels.h"
#include "state/views.h"
#include "superclusters/superclusters.h"

/* Blurs the texture planes with sigma 2 px (a 5 x 5 box twice), in place, through the key planes. */
void t3r_blur_texture(const t3r_kernels *kernels, const t3r_view *views, uint32_t count, const t3r_workers *workers);

/* Computes the mean texture of every cluster (eq. 2) from the unblurred texture planes. */
void t3r_cluster_texture(const t3r_view *views, uint32_t count, t3r_cluster *clusters, uint32_t cluster_count);

/* Permutes the textures of the clusters that have points, each permutation with the same probability. */
void t3r_shuffle_texture(t3r_cluster *clusters, uint32_t cluster_count, uint32_t seed);

/* Orders clusters by rising texture. t3r_are_ranked(): whether they are in that order, for any entries. */
void t3r_rank_clusters(t3r_cluster *clusters, uint32_t cluster_count);
bool t3r_are_ranked(const t3r_cluster *clusters, uint32_t cluster_count);

#endif
