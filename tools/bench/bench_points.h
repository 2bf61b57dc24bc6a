/* The bench's points: six numbers each, clustered by the runtime's K-means and judged in double. */
#ifndef TRIM3R_TOOLS_BENCH_POINTS_H
#define TRIM3R_TOOLS_BENCH_POINTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "superclusters/superclusters.h"
#include "trim3r.h"

typedef struct bench_points {
    uint32_t count;
    float (*value)[T3R_DIMENSIONS];         /* as given */
    int16_t (*feature_q11)[T3R_DIMENSIONS]; /* less `middle`, times `scale`, a power of two */
    double middle[T3R_DIMENSIONS], scale;
    uint16_t *labels;
    t3r_cluster clusters[T3R_MAX_CLUSTERS];
    void *work;
} bench_points;

/* Raw float32, little-endian, N x 6. 0, or -1 with "what, where" in error[]; bench_points_free() in either case. */
int bench_points_read(bench_points *points, const char *path, char *error, size_t error_bytes);
/* The pixels of views with depth in millimetres, none of it missing: xyz over the median depth, rgb over 255. */
int bench_points_unproject(bench_points *points, uint32_t views, uint32_t width, uint32_t height, uint8_t *const *rgb,
                           uint16_t *const *depth_mm, const t3r_camera *cameras, char *error, size_t error_bytes);
/* One K-means with the default settings; false when it failed. */
bool bench_points_cluster(bench_points *points, uint32_t cpu);
/* Of the points as given from their centres. */
double bench_points_mean_squared_distance(const bench_points *points);
void bench_points_free(bench_points *points);

#endif
