#include "pixel_clusters.h"

#include "core/fixed.h"
#include "core/memory.h"
#include "one_cluster.h"
#include "pointmap/reproject.h"
#include "state/state.h"
#include "superclusters.h"

/* Pixels of all views, view after view, as points: x, y, z over the median depth and r, g, b over 255. */
typedef struct pixel_points {
    const t3r_view *views;
    t3r_pointmap maps[T3R_MAX_VIEWS];
    const t3r_kernels *kernels;
    uint32_t pixels;
    int64_t inverse_median_q30; /* of the median depth in scene units */
    int32_t colour_scale_q16;   /* 8-bit level to Q11 */
} pixel_points;

/* Computes the features of a batch of pixels of view v, and empties the batch. */
static void write_features(const pixel_points *source, uint32_t v, t3r_points *points,
                           int16_t feature_q11[][T3R_DIMENSIONS])
{
    const t3r_view *view = &source->views[v];
    const t3r_unprojection from = t3r_unprojection_of(&source->maps[v]);
    source->kernels->unproject(&from, points);
    for (uint32_t i = 0; i < points->count; i++) {
        const size_t pixel = (size_t)points->v[i] * view->width + points->u[i];
        for (int k = 0; k < 3; k++) {
            /* |point| <= 2^30, the inverse <= 2^30 */
            int64_t x = t3r_round_shift64(points->point_q20[k][i] * source->inverse_median_q30, 39);
            feature_q11[i][k] = (int16_t)t3r_clamp64(x, -T3R_FEATURE_MOST, T3R_FEATURE_MOST);
            feature_q11[i][3 + k] = (int16_t)t3r_round_shift32(view->colour[k][pixel] * source->colour_scale_q16, 16);
        }
    }
    points->count = 0;
}

static uint32_t pixel_features(const void *context, const uint32_t *index, uint32_t count,
                               int16_t feature_q11[][T3R_DIMENSIONS], uint8_t *which)
{
    const pixel_points *source = context;
    t3r_points points = {0};
    uint32_t valid = 0, written = 0, v = index[0] / source->pixels;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t view = index[i] / source->pixels, pixel = index[i] % source->pixels;
        if (view != v) {
            write_features(source, v, &points, feature_q11 + written);
            written = valid;
            v = view;
        }
        if (t3r_has_depth(source->views[v].validity[pixel])) {
            const uint32_t row = pixel / source->views[v].width;
            t3r_add_pixel(&points, &source->views[v], pixel - row * source->views[v].width, row);
            which[valid++] = (uint8_t)i;
        }
    }
    write_features(source, v, &points, feature_q11 + written);
    return valid;
}

/* Stores labels. Planes of all views follow each other in memory, so the index may run across views. */
static void label_pixels(const void *context, uint32_t first, const uint8_t *which, uint32_t count,
                         const uint16_t *label)
{
    const t3r_view first_view = ((const pixel_points *)context)->views[0];
    for (uint32_t i = 0; i < count; i++) {
        t3r_set_label(&first_view, first + which[i], label[i]);
    }
}

static bool step_clusters(void *context, uint32_t done, uint32_t total)
{
    return t3r_progress(context, T3R_STAGE_SUPERCLUSTERS, done, total);
}

t3r_status t3r_cluster_pixels(t3r_runtime *rt, const t3r_view *views)
{
    if (rt->config.clusters == 1) {
        (void)t3r_one_cluster(views, rt->views, t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS));
        return t3r_progress(rt, T3R_STAGE_SUPERCLUSTERS, 0, 1) ? T3R_OK : T3R_ERR_CANCELLED;
    }
    pixel_points points = {
        .views = views,
        .kernels = &rt->kernels,
        .pixels = rt->config.width * rt->config.height,
        .inverse_median_q30 = ((int64_t)1 << 50) / rt->median_depth_q20,
        .colour_scale_q16 = (int32_t)((rt->config.colour_weight_q8 << 19) / 255),
    };
    t3r_pointmaps_of(views, rt->views, rt->frame.exponent, points.maps);
    t3r_point_source source = {&points, points.pixels * rt->views, pixel_features, label_pixels};
    t3r_cluster_settings settings = {&rt->kernels, rt->config.clusters, rt->config.cluster_batches, rt->config.seed,
                                     rt->reuse.centres != 0};
    const t3r_cluster_host host = {
        .workers = t3r_workers_of(rt),
        .sums = t3r_buffer_at(rt, T3R_BUFFER_CLUSTER_SUMS),
        .context = rt,
        .step = step_clusters,
    };
    if (settings.follows) {
        memcpy(t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS), t3r_buffer_at(rt, T3R_BUFFER_KEPT_CLUSTERS),
               rt->config.clusters * sizeof(t3r_cluster));
    }
    const uint32_t valid = t3r_superclusters(&source, &settings, t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS),
                                             t3r_buffer_at(rt, T3R_BUFFER_CLUSTER_WORK), &host);
    return valid == T3R_CLUSTERS_CANCELLED ? T3R_ERR_CANCELLED : T3R_OK;
}
