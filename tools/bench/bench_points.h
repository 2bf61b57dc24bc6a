/* The bench's points: six numbers each, clustered by the runtime's K-means and evaluated in double. */
#ifndef TRIM3R_TOOLS_BENCH_POINTS_H
#define TRIM3R_TOOLS_BENCH_POINTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "superclusters/superclusters.h"
#include "trim3r.h"

typedef struct bench_points {
    uint32_t count;
    float (*value)[T3R_DIMENSIONS];         /* as read */
    int16_t (*feature_q11)[T3R_DIMENSIONS]; /* minus `middle`, times `scale`, a power of two */
    double middle[T3R_DIMENSIONS], scale;
    uint16_t *labels;
    t3r_cluster clusters[T3R_MAX_CLUSTERS];
    void *work;
} bench_points;

/* Reads raw float32, little-endian, N x 6. Returns 0, or -1 with "what, where" in error[]; bench_points_free() is due
 * in either case. */
int bench_points_read(bench_points *points, const char *path, char *error, size_t error_bytes);
/* Makes points of the pixels of views with depth in millimetres, none of it missing: xyz divided by the median depth,
 * rgb by 255. */
int bench_points_unproject(bench_points *points, uint32_t views, uint32_t width, uint32_t height, uint8_t *const *rgb,
                           uint16_t *const *depth_mm, const t3r_camera *cameras, char *error, size_t error_bytes);
/* Runs K-means once with the default settings; false when it failed. */
bool bench_points_cluster(bench_points *points, uint32_t cpu);
/* Returns the mean squared distance of the points, as read, from their centres. */
double bench_points_mean_squared_distance(const bench_points *points);
void bench_points_free(bench_points *points);

#endif
