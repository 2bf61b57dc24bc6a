#include "bench/bench_points.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/camera.h"
#include "host/file_bytes.h"
#include "host/little_floats.h"
#include "host/reason.h"

/* values of GaussianTrim3R */
enum { CLUSTERS = 300, BATCHES = 24 };

void bench_points_free(bench_points *points)
{
    free(points->value);
    free(points->feature_q11);
    free(points->labels);
    free(points->work);
    *points = (bench_points){0};
}

static int allocate(bench_points *p, uint32_t count, char *error, size_t error_bytes)
{
    *p = (bench_points){.count = count};
    p->value = calloc(count, sizeof *p->value);
    p->feature_q11 = calloc(count, sizeof *p->feature_q11);
    p->labels = calloc(count, sizeof *p->labels);
    p->work = aligned_alloc(T3R_ARENA_ALIGN, T3R_CLUSTER_WORK_BYTES(CLUSTERS));
    if (p->value == NULL || p->feature_q11 == NULL || p->labels == NULL || p->work == NULL) {
        return t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " points", count);
    }
    return 0;
}

/* Quantizes around the middle of the range, multiplied by `scale`, which is halved until it fits. Neither changes which
 * points are nearest. */
static void quantize(bench_points *p, double scale)
{
    double half_range = 0;
    for (int d = 0; d < T3R_DIMENSIONS; d++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; i < p->count; i++) {
            low = fmin(low, p->value[i][d]);
            high = fmax(high, p->value[i][d]);
        }
        p->middle[d] = (low + high) / 2;
        half_range = fmax(half_range, (high - low) / 2);
    }
    p->scale = scale;
    while (half_range * p->scale > T3R_FEATURE_MOST) {
        p->scale /= 2;
    }
    for (uint32_t i = 0; i < p->count; i++) {
        for (int d = 0; d < T3R_DIMENSIONS; d++) {
            p->feature_q11[i][d] = (int16_t)nearbyint((p->value[i][d] - p->middle[d]) * p->scale);
        }
    }
}

int bench_points_read(bench_points *points, const char *path, char *error, size_t error_bytes)
{
    *points = (bench_points){0};
    size_t bytes;
    uint8_t *data = t3r_file_bytes(path, SIZE_MAX, &bytes, error, error_bytes);
    if (data == NULL) {
        return -1;
    }
    size_t row = 4 * T3R_DIMENSIONS, count = bytes / row;
    int result = -1;
    if (bytes % row != 0 || count == 0 || count > T3R_MAX_GAUSSIANS) {
        t3r_reason(error, error_bytes, "%s: %zu bytes are not N x 6 float32 with N in 1..%u", path, bytes,
                   T3R_MAX_GAUSSIANS);
    } else {
        result = allocate(points, (uint32_t)count, error, error_bytes);
    }
    for (size_t i = 0; result == 0 && i < count * T3R_DIMENSIONS; i++) {
        const float value = t3r_load_float(data + 4 * i);
        if (!isfinite(value)) {
            t3r_reason(error, error_bytes, "%s: byte %zu: not a finite number", path, 4 * i);
            result = -1;
        }
        points->value[i / T3R_DIMENSIONS][i % T3R_DIMENSIONS] = value;
    }
    free(data);
    if (result == 0) {
        quantize(points, 0x1p120); /* input of any size: as many steps as fit */
    }
    return result;
}

static int compare_u16(const void *a, const void *b)
{
    return (int)*(const uint16_t *)a - (int)*(const uint16_t *)b;
}

static double median_depth(uint32_t views, size_t pixels, uint16_t *const *depth, uint16_t *sorted)
{
    for (uint32_t v = 0; v < views; v++) {
        memcpy(sorted + v * pixels, depth[v], pixels * sizeof *sorted);
    }
    qsort(sorted, views * pixels, sizeof *sorted, compare_u16);
    return sorted[views * pixels / 2];
}

int bench_points_unproject(bench_points *points, uint32_t views, uint32_t width, uint32_t height, uint8_t *const *rgb,
                           uint16_t *const *depth_mm, const t3r_camera *cameras, char *error, size_t error_bytes)
{
    size_t pixels = (size_t)width * height;
    if (allocate(points, views * width * height, error, error_bytes) != 0) {
        return -1;
    }
    /* the labels, as many and as wide, are a buffer for sorting */
    double median = median_depth(views, pixels, depth_mm, points->labels);
    for (uint32_t v = 0; v < views; v++) {
        const t3r_camera *c = &cameras[v];
        int32_t rotation_q30[9];
        t3r_camera_rotation(c->rotation_q30, rotation_q30);
        for (size_t i = 0; i < pixels; i++) {
            float *value = points->value[v * pixels + i];
            double z = depth_mm[v][i];
            double ray[3] = {((double)(i % width) * 65536 - c->cx_q16) / c->fx_q16 * z,
                             ((double)(i / width) * 65536 - c->cy_q16) / c->fy_q16 * z, z};
            for (int d = 0; d < 3; d++) {
                const int32_t *row = rotation_q30 + 3 * d;
                double turned = ldexp(row[0] * ray[0] + row[1] * ray[1] + row[2] * ray[2], -30);
                /* positions are metres, depths millimetres */
                value[d] = (float)((turned + ldexp((double)c->position_q32[d], -32) * 1000) / median);
                value[3 + d] = (float)(rgb[v][3 * i + (size_t)d] / 255.0);
            }
        }
    }
    quantize(points, 2048); /* Q11, as in the runtime */
    return 0;
}

static uint32_t features_of(const void *context, const uint32_t *index, uint32_t count,
                            int16_t feature_q11[][T3R_DIMENSIONS], uint8_t *which)
{
    const bench_points *points = context;
    for (uint32_t i = 0; i < count; i++) {
        memcpy(feature_q11[i], points->feature_q11[index[i]], sizeof feature_q11[i]);
        which[i] = (uint8_t)i;
    }
    return count;
}

static void note_labels(const void *context, uint32_t first, const uint8_t *which, uint32_t count,
                        const uint16_t *label)
{
    const bench_points *points = context;
    for (uint32_t i = 0; i < count; i++) {
        points->labels[first + which[i]] = label[i];
    }
}

bool bench_points_cluster(bench_points *points, uint32_t cpu)
{
    t3r_kernels kernels;
    t3r_kernels_choose(&kernels, cpu);
    t3r_config defaults = t3r_default_config(T3R_MIN_SIDE, T3R_MIN_SIDE, 1, 1);
    t3r_point_source source = {points, points->count, features_of, note_labels};
    t3r_cluster_settings settings = {&kernels, CLUSTERS, BATCHES, defaults.seed, false};
    const t3r_cluster_host alone = {.workers = {NULL, 1}};
    return t3r_superclusters(&source, &settings, points->clusters, points->work, &alone) == points->count;
}

double bench_points_mean_squared_distance(const bench_points *points)
{
    double sum = 0;
    for (uint32_t i = 0; i < points->count; i++) {
        const t3r_cluster *cluster = &points->clusters[points->labels[i]];
        for (int d = 0; d < T3R_DIMENSIONS; d++) {
            double centre = points->middle[d] + ldexp(cluster->centre_q19[d], 11 - 19) / points->scale;
            sum += (points->value[i][d] - centre) * (points->value[i][d] - centre);
        }
    }
    return sum / points->count;
}
