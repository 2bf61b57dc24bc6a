/* SPDX-License-Identifier: Apache-2.0 */
/* SuperClusters: K-means on x, y, z, r, g, b (GaussianTrim3R 3.1.1, eq. 1) by bounded mini-batches and one assignment
 * pass. The work memory depends on K, not on the number of points (SPEC.md, "SuperClusters"). */
#ifndef T3R_SUPERCLUSTERS_H
#define T3R_SUPERCLUSTERS_H

#include <stdbool.h>
#include <stdint.h>

#include "core/fixed.h"
#include "core/workers.h"
#include "kernels/kernels.h"
#include "state/views.h"
#include "trim3r.h"

#define T3R_CLUSTER_BATCH 4096u /* maximum points of a mini-batch */
#define T3R_CLUSTER_POINTS 16u  /* points of the sample and of a mini-batch for each SuperCluster */
#define T3R_CLUSTER_TRIALS 4u   /* draws for a new centre, of which the best is taken */
#define T3R_CENTRE_FRACTION 8   /* extra fraction bits of a centre over a feature, which keep small steps */

_Static_assert(T3R_SAMPLE_ROOM_(1) == T3R_CLUSTER_POINTS && T3R_SAMPLE_ROOM_(T3R_MAX_CLUSTERS) == T3R_CLUSTER_SAMPLE &&
                   T3R_CENTRE_ROOM_(1) == T3R_CENTRE_GROUP && T3R_NEIGHBOURS == 12,
               "trim3r_arena.h knows the K-means' work");

/* Returns the maximum number of points in the seeding's sample. */
static inline uint32_t t3r_cluster_sample(uint32_t clusters)
{
    return (uint32_t)T3R_SAMPLE_ROOM_(clusters);
}

/* Returns the maximum number of points in a mini-batch. */
static inline uint32_t t3r_cluster_batch(uint32_t clusters)
{
    return T3R_MIN(clusters * T3R_CLUSTER_POINTS, T3R_CLUSTER_BATCH);
}

/* Source of points and destination of their labels. features() takes up to T3R_POINTS indices below `points`. It writes
 * the six features of the valid ones without gaps, Q11 within +-T3R_FEATURE_MOST, and which of the indices are valid,
 * and returns their number. label() takes the label of each valid point once; workers call it at the same time for
 * different points. */
typedef struct t3r_point_source {
    const void *context;
    uint32_t points;
    uint32_t (*features)(const void *context, const uint32_t *index, uint32_t count,
                         int16_t feature_q11[][T3R_DIMENSIONS], uint8_t *which);
    void (*label)(const void *context, uint32_t first, const uint8_t *which, uint32_t count, const uint16_t *label);
} t3r_point_source;

/* The smallest density that is stored, 0.003: log2(197 / 65536). */
#define T3R_LEAST_DENSITY_Q10 (-8579)

/* A SuperCluster, with the budget stage's results. */
typedef struct t3r_cluster {
    int32_t centre_q19[T3R_DIMENSIONS];
    uint32_t points;     /* valid points with its label; 0 = empty */
    uint32_t texture_q4; /* their mean texture energy (eq. 2) */
    uint32_t deferred;   /* its points that this budget retains last */
    uint32_t quota;      /* points to retain */
    uint32_t threshold;  /* largest key retained */
    uint32_t ties;       /* points retained among those with the threshold's key */
    uint32_t order;      /* entry k: index of the cluster with the k-th lowest texture */
    int32_t density_q10; /* log2 of the share of points retained, at a texture power of 1 */
} t3r_cluster;

typedef struct t3r_cluster_settings {
    const t3r_kernels *kernels;
    uint32_t clusters, batches, seed;
    bool follows; /* the clusters hold centres of similar points to start from */
} t3r_cluster_settings;

/* The host of the K-means: its workers, and a step called between batches, chunks of the assignment pass, and a few of
 * the first centres. */
typedef struct t3r_cluster_host {
    t3r_workers workers;
    void *sums; /* T3R_CLUSTER_SUMS_BYTES(K) for each worker except worker 0, aligned to T3R_ARENA_ALIGN; NULL with one
                   worker */
    void *context;
    bool (*step)(void *context, uint32_t done, uint32_t total); /* returns false to cancel; NULL: never cancels */
} t3r_cluster_host;

static inline bool t3r_cluster_step(const t3r_cluster_host *host, uint32_t done, uint32_t total)
{
    return host->step == NULL || host->step(host->context, done, total);
}

/* Clusters the source's points: fills clusters[0..K-1] and labels each valid point. `work` is
 * T3R_CLUSTER_WORK_BYTES(K), aligned to T3R_ARENA_ALIGN; K is at least 2. Returns the number of valid points, or
 * T3R_CLUSTERS_CANCELLED. */
#define T3R_CLUSTERS_CANCELLED UINT32_MAX
uint32_t t3r_superclusters(const t3r_point_source *source, const t3r_cluster_settings *settings, t3r_cluster *clusters,
                           void *work, const t3r_cluster_host *host);

#endif
