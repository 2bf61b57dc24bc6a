/* SPDX-License-Identifier: Apache-2.0 */
#include "bench/bench_stages.h"

#include <string.h>

#include "bench/bench_head.h"
#include "bench/bench_limits.h"
#include "bench/bench_network.h"
#include "bench/bench_pairs.h"
#include "bench/bench_refine.h"
#include "bench/bench_stereo.h"
#include "wavelet/wavelet.h"

/* ---- runs ------------------------------------------------------------------------------------------------------ */

static bool run_raster_full(bench_work *w)
{
    return bench_work_draw(w, BENCH_FULL) == T3R_OK;
}

static bool run_raster_trimmed(bench_work *w)
{
    return bench_work_draw(w, BENCH_TRIMMED) == T3R_OK;
}

static bool run_build(bench_work *w)
{
    return bench_work_build(w, BENCH_TRIMMED) == T3R_OK;
}

static bool run_build_unrefined(bench_work *w)
{
    return bench_work_build(w, BENCH_UNREFINED) == T3R_OK;
}

static bool run_build_learned(bench_work *w)
{
    return bench_work_build(w, BENCH_LEARNED) == T3R_OK;
}

static bool run_head(bench_work *w)
{
    return bench_head_run(w->scene[BENCH_HEADED].runtime);
}

static bool run_network(bench_work *w)
{
    return bench_network_run(w->scene[BENCH_NETWORKED].runtime, w->features);
}

static bool run_refine(bench_work *w)
{
    return bench_refine_run(w->scene[BENCH_REFINED].runtime, w->start);
}

static bool run_stereo(bench_work *w)
{
    return bench_stereo_run(w->scene[BENCH_MATCHED].runtime);
}

static bool run_stereo_8_paths(bench_work *w)
{
    return bench_stereo_paths_run(w->scene[BENCH_MATCHED].runtime, BENCH_MORE_PATHS, w->stereo_work);
}

static bool run_kmeans(bench_work *w)
{
    return bench_points_cluster(&w->points, w->cpu);
}

static bool run_texture(bench_work *w)
{
    size_t pixels = (size_t)BENCH_WAVELET_WIDTH * BENCH_WAVELET_HEIGHT;
    const uint8_t *colour[3] = {w->wavelet_planes, w->wavelet_planes + pixels, w->wavelet_planes + 2 * pixels};
    t3r_wavelet_texture(&w->kernels, colour, BENCH_WAVELET_WIDTH, BENCH_WAVELET_HEIGHT, 2, T3R_WAVELET_DB2, w->texture,
                        w->wavelet_plane, w->wavelet_work);
    return true;
}

static bool run_multiply_adds(bench_work *w)
{
    w->multiply_adds = bench_multiply_adds(w->cpu);
    return true;
}

static bool run_copy(bench_work *w)
{
    bench_copy(w->copy_to, w->copy_from);
    return true;
}

/* ---- items per run --------------------------------------------------------------------------------------------- */

static double pairs_of(bench_work *w, bench_scene scene, bool (*run)(bench_work *w))
{
    bench_pairs_begin(w->scene[scene].runtime);
    const bool good = run(w);
    const double pairs = bench_pairs_end(w->scene[scene].runtime);
    return good ? pairs : 0;
}

static double pairs_of_full(bench_work *w)
{
    return pairs_of(w, BENCH_FULL, run_raster_full);
}

static double pairs_of_trimmed(bench_work *w)
{
    return pairs_of(w, BENCH_TRIMMED, run_raster_trimmed);
}

static double pairs_of_refinement(bench_work *w)
{
    return pairs_of(w, BENCH_REFINED, run_refine);
}

static double pixels(bench_work *w)
{
    (void)w;
    return BENCH_POINTS;
}

static double pixels_of_texture(bench_work *w)
{
    (void)w;
    return (double)BENCH_WAVELET_WIDTH * BENCH_WAVELET_HEIGHT;
}

static double points(bench_work *w)
{
    return w->points.count;
}

static double macs_of_head(bench_work *w)
{
    return bench_head_macs(w->measured.weights, BENCH_SIDE, BENCH_SIDE, BENCH_VIEWS);
}

static double multiply_adds(bench_work *w)
{
    return w->multiply_adds;
}

static double bytes_copied(bench_work *w)
{
    (void)w;
    return 2.0 * BENCH_COPY_BYTES; /* read and written */
}

/* ---- the rows -------------------------------------------------------------------------------------------------- */

const bench_stage bench_stages[BENCH_STAGES_MOST + 1] = {
    {"raster_131k_ms", run_raster_full, BENCH_FULL, pairs_of_full, "ns a blended pair", "raster_131k_ns_per_pair"},
    {"raster_13k_ms", run_raster_trimmed, BENCH_TRIMMED, pairs_of_trimmed, "ns a blended pair",
     "raster_13k_ns_per_pair"},
    {"refine_ms", run_refine, BENCH_REFINED, pairs_of_refinement, "ns a blended pair", "refine_ns_per_pair"},
    {"stereo_ms", run_stereo, BENCH_MATCHED, pixels, "ns a pixel", "stereo_ns_per_pixel"},
    {"stereo_8_paths_ms", run_stereo_8_paths, BENCH_MATCHED, pixels, "ns a pixel", "stereo_8_paths_ns_per_pixel"},
    {"kmeans_ms", run_kmeans, BENCH_NO_SCENE, points, "ns a point", "kmeans_ns_per_point"},
    {"texture_ns_per_pixel", run_texture, BENCH_NO_SCENE, pixels_of_texture, NULL, NULL},
    {"build_analytic_ms", run_build, BENCH_TRIMMED, pixels, "ns a pixel", "build_analytic_ns_per_pixel"},
    {"build_unrefined_ms", run_build_unrefined, BENCH_UNREFINED, pixels, "ns a pixel", "build_unrefined_ns_per_pixel"},
    {"build_small_ms", run_build_learned, BENCH_LEARNED, pixels, "ns a pixel", "build_small_ns_per_pixel"},
    {"head_gmac_per_s", run_head, BENCH_HEADED, macs_of_head, "ns a multiply-accumulate", "head_ns_per_mac"},
    {"network_ms", run_network, BENCH_NETWORKED, pixels, "ns a pixel", "network_ns_per_pixel"},
    {"machine_gmac_per_s", run_multiply_adds, BENCH_NO_SCENE, multiply_adds, NULL, NULL},
    {"machine_copy_gb_per_s", run_copy, BENCH_NO_SCENE, bytes_copied, NULL, NULL},
};

static bool ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text), tail = strlen(end);
    return length >= tail && strcmp(text + length - tail, end) == 0;
}

bool bench_stage_is_rate(const char *key)
{
    return ends_with(key, "_per_s");
}

bool bench_stage_is_build(const char *key)
{
    return strncmp(key, "build_", 6) == 0;
}

double bench_stage_figure(const bench_stage *stage, double seconds, double items)
{
    if (bench_stage_is_rate(stage->key)) {
        return items / 1e9 / seconds;
    }
    return ends_with(stage->key, "_ms") ? seconds * 1e3 : seconds * 1e9 / items;
}
