/* SPDX-License-Identifier: Apache-2.0 */
#include "scene_scale.h"

#include "core/fixed.h"
#include "core/memory.h"
#include "core/scene_frame.h"

/* Returns floor(log2) of a raw depth in world units, Q40, offset so that it is never negative: raw < 2^16, unit <
 * 2^64. */
static uint32_t octave(uint64_t depth_unit_q40, uint16_t raw)
{
    uint64_t high = (depth_unit_q40 >> 32) * raw + (((depth_unit_q40 & UINT32_MAX) * raw) >> 32);
    return high != 0 ? 32 + t3r_msb64(high) : t3r_msb64((depth_unit_q40 & UINT32_MAX) * raw);
}

#define OCTAVES 96
/* Bins between 1 and 2 scene units; the next bin counts nearer depths. */
#define STEPS 1024
#define NEARER STEPS
#define BINS (STEPS + 64) /* bins a worker, padded so that workers share no cache line */

/* Histogram of the measured depths of all views: one per worker, finally summed into worker 0's. */
typedef struct count_job {
    const t3r_view *view;
    int32_t exponent;
    uint32_t *bins;
} count_job;

static uint32_t *bins_of(const count_job *job, uint32_t worker)
{
    return job->bins + (size_t)worker * BINS;
}

static void count_octaves(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    const count_job *job = context;
    const t3r_view view = *job->view;
    uint32_t *bins = bins_of(job, worker);
    for (size_t i = (size_t)begin * view.width; i < (size_t)end * view.width; i++) {
        if (t3r_is_reliable(view.validity[i])) { /* so it has a depth */
            bins[octave(view.depth_unit_q40, view.depth[i])]++;
        }
    }
}

static void count_steps(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    const count_job *job = context;
    const t3r_view view = *job->view;
    const t3r_depth_scale scale = t3r_depth_scale_of(view.depth_unit_q40, job->exponent);
    uint32_t *bins = bins_of(job, worker);
    for (size_t i = (size_t)begin * view.width; i < (size_t)end * view.width; i++) {
        if (!t3r_is_reliable(view.validity[i])) {
            continue;
        }
        const int32_t depth = t3r_depth_q20(scale, view.depth[i]);
        if (depth < 1 << 20) {
            bins[NEARER]++;
        } else if (depth < 2 << 20) {
            bins[(depth - (1 << 20)) >> 10]++;
        }
    }
}

/* Returns all workers if the work memory has room for their histograms, else one. */
static t3r_workers workers_of(const t3r_view *views, const t3r_pointmap_work *work)
{
    const size_t room = (size_t)views[0].width * views[0].height + 3 * T3R_RATIO_BINS;
    return room / BINS >= work->workers.count ? work->workers : (t3r_workers){NULL, 1};
}

static void count_views(const t3r_view *views, uint32_t count, const t3r_pointmap_work *work, count_job *job,
                        t3r_rows_task *rows)
{
    const t3r_workers workers = workers_of(views, work);
    job->bins = work->pixels;
    memset(job->bins, 0, (size_t)workers.count * BINS * sizeof *job->bins);
    for (uint32_t v = 0; v < count; v++) {
        job->view = &views[v];
        t3r_run_rows(&workers, views[v].height, rows, job);
    }
    for (uint32_t w = 1; w < workers.count; w++) {
        for (uint32_t bin = 0; bin < BINS; bin++) {
            job->bins[bin] += bins_of(job, w)[bin];
        }
    }
}

/* Returns the first bin at which the running sum passes half of the total. */
static uint32_t median_bin(const uint32_t *histogram, uint32_t bins, uint64_t total, uint64_t before)
{
    uint64_t sum = before;
    for (uint32_t bin = 0; bin + 1 < bins; bin++) {
        sum += histogram[bin];
        if (2 * sum > total) {
            return bin;
        }
    }
    return bins - 1;
}

/* Chooses the exponent and returns the number of depths. */
static uint64_t choose_exponent(const t3r_view *views, uint32_t count, const t3r_pointmap_work *work, int32_t *exponent)
{
    count_job job = {0};
    count_views(views, count, work, &job, count_octaves);
    uint64_t total = 0;
    for (uint32_t bin = 0; bin < OCTAVES; bin++) {
        total += job.bins[bin];
    }
    const uint32_t middle = median_bin(job.bins, OCTAVES, total, 0);
    *exponent = t3r_clamp32((int32_t)middle - 40, T3R_EXPONENT_LEAST, T3R_EXPONENT_MOST);
    return total;
}

t3r_status t3r_scene_exponent(const t3r_view *views, uint32_t count, const t3r_pointmap_work *work, int32_t *exponent)
{
    return choose_exponent(views, count, work, exponent) > 0 ? T3R_OK : T3R_ERR_NO_DEPTH;
}

t3r_status t3r_scene_scale_choose(const t3r_view *views, uint32_t count, const t3r_pointmap_work *work,
                                  int32_t *exponent, int32_t *median_q20)
{
    const uint64_t total = choose_exponent(views, count, work, exponent);
    if (total == 0) {
        return T3R_ERR_NO_DEPTH;
    }
    count_job job = {.exponent = *exponent};
    count_views(views, count, work, &job, count_steps);
    const uint32_t bin = median_bin(job.bins, STEPS, total, job.bins[NEARER]);
    *median_q20 = (1 << 20) + (int32_t)(bin << 10) + 512;
    return T3R_OK;
}
