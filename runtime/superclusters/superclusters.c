/* SPDX-License-Identifier: Apache-2.0 */
#include "superclusters.h"

#include "core/cut.h"
#include "core/fixed.h"
#include "core/memory.h"
#include "seeding.h"

#define BLOCK T3R_POINTS  /* points gathered at a time */
#define TASK_POINTS 512u  /* points a task labels */
#define FOLLOW_PART 6u    /* a build that follows another takes 1 / FOLLOW_PART of the batches */
#define FOLLOW_WEIGHT 16u /* initial weight of a reused centre, in points */
#define FOLLOW_SHARE                                                                                                   \
    2u /* such a centre is kept if its points in the first batch are at least 1 / FOLLOW_SHARE of the                  \
        * mean */
#define WEIGHT_MOST 2048u /* bound of a centre's weight, so that late batches still move it */

static void load_centres(t3r_centres *centres, const t3r_cluster *clusters, uint32_t count)
{
    centres->count = count;
    for (uint32_t k = 0; k < count; k++) {
        int32_t norm = 0; /* at most 6 x 15000^2 < 2^31 */
        for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
            int16_t c = (int16_t)t3r_round_shift32(clusters[k].centre_q19[d], T3R_CENTRE_FRACTION);
            centres->feature_q11[d][k] = c;
            norm += c * c;
        }
        centres->half_norm[k] = norm / 2;
    }
}

/* Sums over the points of each SuperCluster. */
typedef struct cluster_sums {
    int64_t (*sum)[T3R_DIMENSIONS];
    uint32_t *points;
} cluster_sums;

/* A pass over points that workers share. Each worker adds to its own sums, which are added up at the end. */
typedef struct means_job {
    const t3r_kernels *kernels;
    const t3r_point_source *source;
    const t3r_cluster_host *host;
    uint32_t count; /* number of centres */
    t3r_centres centres;
    t3r_sample sample; /* used while centres are placed, in the memory of the fields below */
    t3r_neighbours neighbours;
    cluster_sums sums[T3R_MAX_WORKERS]; /* sums[0] finally holds the sums of all workers */
    uint32_t *weight;                   /* points averaged into each centre so far, at most WEIGHT_MOST */
    uint32_t first;                     /* index of the first task's block of TASK_POINTS */
    uint32_t batch;                     /* number of the batch */
    uint32_t points;                    /* of this pass */
} means_job;

static cluster_sums cut_sums(t3r_cut *cut, uint32_t clusters)
{
    cluster_sums sums = {t3r_take(cut, clusters * sizeof *sums.sum), NULL};
    sums.points = t3r_take(cut, clusters * sizeof *sums.points);
    return sums;
}

/* Cuts up the work memory that trim3r_arena.h plans. */
static void cut_work(means_job *job, void *work)
{
    const uint32_t room = (uint32_t)T3R_CENTRE_ROOM_(job->count), points = t3r_cluster_sample(job->count);
    t3r_cut cut = t3r_cut_of(work, T3R_CLUSTER_WORK_BYTES(job->count));
    int16_t *centres = t3r_take(&cut, room * T3R_DIMENSIONS * sizeof *centres);
    job->centres.half_norm = t3r_take(&cut, room * sizeof *job->centres.half_norm);
    t3r_cut sample = cut;
    int16_t *sampled = t3r_take(&sample, points * T3R_DIMENSIONS * sizeof *sampled);
    job->sample.distance_q20 = t3r_take(&sample, points * sizeof *job->sample.distance_q20);
    for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
        job->centres.feature_q11[d] = centres + d * room;
        job->sample.feature_q11[d] = sampled + d * points;
    }
    job->neighbours.index = t3r_take(&cut, room * sizeof *job->neighbours.index);
    job->sums[0] = cut_sums(&cut, job->count);
    job->weight = t3r_take(&cut, job->count * sizeof *job->weight);
    const uint32_t others = job->host->workers.count - 1;
    cut = t3r_cut_of(job->host->sums, others * T3R_CLUSTER_SUMS_BYTES(job->count));
    for (uint32_t w = 1; w <= others; w++) {
        job->sums[w] = cut_sums(&cut, job->count);
    }
}

static void clear_sums(const means_job *job)
{
    for (uint32_t w = 0; w < job->host->workers.count; w++) {
        memset(job->sums[w].sum, 0, job->count * sizeof *job->sums[w].sum);
        memset(job->sums[w].points, 0, job->count * sizeof *job->sums[w].points);
    }
}

static void join_sums(const means_job *job)
{
    const cluster_sums *to = &job->sums[0];
    for (uint32_t w = 1; w < job->host->workers.count; w++) {
        const cluster_sums *from = &job->sums[w];
        for (uint32_t k = 0; k < job->count; k++) {
            to->points[k] += from->points[k];
            for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
                to->sum[k][d] += from->sum[k][d];
            }
        }
    }
}

static void add_point(const cluster_sums *sums, uint16_t label, const int16_t feature[T3R_DIMENSIONS])
{
    sums->points[label]++;
    for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
        sums->sum[label][d] += feature[d]; /* below 2^32 x 2^14 */
    }
}

/* Labels `valid` gathered points and adds them to the worker's sums. Labels don't depend on the guess. */
static void label_block(const means_job *job, uint32_t worker, uint32_t valid, const int16_t feature[][T3R_DIMENSIONS],
                        uint16_t *guess, uint16_t *label)
{
    job->kernels->nearest(&job->centres, &job->neighbours, valid, feature, *guess, label);
    for (uint32_t i = 0; i < valid; i++) {
        *guess = label[i];
        add_point(&job->sums[worker], label[i], feature[i]);
    }
}

/* Returns the points of a task: TASK_POINTS from its own place on. */
static t3r_share points_of(const means_job *job, uint32_t index)
{
    const uint32_t begin = (job->first + index) * TASK_POINTS;
    return (t3r_share){begin, T3R_MIN(begin + TASK_POINTS, job->points)};
}

static uint32_t tasks_of(uint32_t points)
{
    return (points + TASK_POINTS - 1) / TASK_POINTS;
}

/* Returns where part s of the source begins. A batch takes one point from each of `job->points` parts. */
static uint32_t part_begin(const means_job *job, uint32_t s)
{
    return (uint32_t)((uint64_t)s * job->source->points / job->points);
}

static void batch_task(void *context, uint32_t index, uint32_t worker)
{
    const means_job *job = context;
    const t3r_point_source *source = job->source;
    const t3r_share points = points_of(job, index);
    uint16_t guess = 0;
    uint32_t begin = part_begin(job, points.begin);
    for (uint32_t first = points.begin; first < points.end; first += BLOCK) {
        int16_t feature[BLOCK][T3R_DIMENSIONS];
        uint16_t label[BLOCK];
        uint8_t which[BLOCK];
        uint32_t place[BLOCK]; /* computed before the first is read, so that memory reads overlap */
        const uint32_t count = T3R_MIN(BLOCK, points.end - first);
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t end = part_begin(job, first + i + 1);
            place[i] = begin + t3r_mix32((first + i) * 1031u + job->batch) % (end - begin);
            begin = end;
        }
        const uint32_t valid = source->features(source->context, place, count, feature, which);
        label_block(job, worker, valid, (const int16_t(*)[T3R_DIMENSIONS])feature, &guess, label);
    }
}

static void begin_groups(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const means_job *job = context;
    job->kernels->nearest_begin(&job->centres, begin * T3R_CENTRE_GROUP, T3R_MIN(end * T3R_CENTRE_GROUP, job->count),
                                &job->neighbours);
}

static void begin_means(means_job *job, const t3r_cluster *clusters)
{
    load_centres(&job->centres, clusters, job->count);
    t3r_run_rows(&job->host->workers, (job->count + T3R_CENTRE_GROUP - 1) / T3R_CENTRE_GROUP, begin_groups, job);
    clear_sums(job);
}

/* Runs one mini-batch (Sculley 2010, with whole-batch means) on points spread over the source, different ones each
 * time. */
static void run_batch(means_job *job, uint32_t batch, t3r_cluster *clusters)
{
    job->batch = batch;
    job->points = T3R_MIN(job->source->points, t3r_cluster_batch(job->count));
    begin_means(job, clusters);
    t3r_run_tasks(&job->host->workers, tasks_of(job->points), batch_task, job);
    join_sums(job);
    const cluster_sums *sums = &job->sums[0];
    for (uint32_t k = 0; k < job->count; k++) {
        uint32_t points = sums->points[k];
        if (points == 0) {
            continue;
        }
        uint32_t *weight = &job->weight[k];
        int64_t before = *weight, after = before + points;
        for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
            int64_t sum = clusters[k].centre_q19[d] * before + (sums->sum[k][d] * (1 << T3R_CENTRE_FRACTION));
            clusters[k].centre_q19[d] = (int32_t)t3r_round_div64(sum, after);
        }
        *weight = T3R_MIN((uint32_t)after, WEIGHT_MOST);
    }
}

static void assign_task(void *context, uint32_t index, uint32_t worker)
{
    const means_job *job = context;
    const t3r_point_source *source = job->source;
    const t3r_share points = points_of(job, index);
    uint16_t guess = 0;
    for (uint32_t first = points.begin; first < points.end; first += BLOCK) {
        int16_t feature[BLOCK][T3R_DIMENSIONS];
        uint32_t place[BLOCK];
        uint16_t label[BLOCK];
        uint8_t which[BLOCK];
        const uint32_t end = T3R_MIN(first + BLOCK, points.end);
        for (uint32_t i = first; i < end; i++) {
            place[i - first] = i;
        }
        const uint32_t valid = source->features(source->context, place, end - first, feature, which);
        label_block(job, worker, valid, (const int16_t(*)[T3R_DIMENSIONS])feature, &guess, label);
        source->label(source->context, first, which, valid, label);
    }
}

/* Labels every point and moves each centre to the mean of its points. */
static uint32_t assign(means_job *job, t3r_cluster *clusters, uint32_t done, uint32_t total)
{
    job->points = job->source->points;
    begin_means(job, clusters);
    const uint32_t tasks = tasks_of(job->points), chunk = T3R_CLUSTER_BATCH / TASK_POINTS;
    for (job->first = 0; job->first < tasks; job->first += chunk) {
        if (!t3r_cluster_step(job->host, done + job->first / chunk, total)) {
            return T3R_CLUSTERS_CANCELLED;
        }
        t3r_run_tasks(&job->host->workers, T3R_MIN(tasks - job->first, chunk), assign_task, job);
    }
    join_sums(job);
    const cluster_sums *sums = &job->sums[0];
    uint32_t all_valid = 0;
    for (uint32_t k = 0; k < job->count; k++) {
        uint32_t points = sums->points[k];
        all_valid += points;
        clusters[k].points = points;
        for (uint32_t d = 0; d < T3R_DIMENSIONS && points > 0; d++) {
            clusters[k].centre_q19[d] = (int32_t)t3r_round_div64(sums->sum[k][d] * (1 << T3R_CENTRE_FRACTION), points);
        }
    }
    return all_valid;
}

static void set_weights(const means_job *job, uint32_t points)
{
    for (uint32_t k = 0; k < job->count; k++) {
        job->weight[k] = points;
    }
}

/* Places all centres again. Returns false when cancelled. */
static bool place_centres(const means_job *job, const t3r_cluster_settings *settings, t3r_cluster *clusters,
                          uint32_t total)
{
    memset(clusters, 0, settings->clusters * sizeof *clusters);
    if (!t3r_seed_centres(job->source, settings, NULL, clusters, &job->sample, job->host, total)) {
        return false;
    }
    set_weights(job, 0);
    return true;
}

/* Runs the first batch with the last build's centres. Centres that get fewer than half of the mean number of its
 * points are placed again. Returns false if cancelled. */
static bool follow_centres(means_job *job, const t3r_cluster_settings *settings, t3r_cluster *clusters, uint32_t total)
{
    bool stays[T3R_MAX_CLUSTERS];
    bool all = true;
    set_weights(job, FOLLOW_WEIGHT);
    run_batch(job, 0, clusters);
    for (uint32_t k = 0; k < settings->clusters; k++) {
        stays[k] = FOLLOW_SHARE * settings->clusters * job->sums[0].points[k] >= job->points;
        all = all && stays[k];
    }
    if (all) {
        return true;
    }
    if (!t3r_seed_centres(job->source, settings, stays, clusters, &job->sample, job->host, total)) {
        return false;
    }
    for (uint32_t k = 0; k < settings->clusters; k++) {
        job->weight[k] = stays[k] ? FOLLOW_WEIGHT : 0;
    }
    return true;
}

uint32_t t3r_superclusters(const t3r_point_source *source, const t3r_cluster_settings *settings, t3r_cluster *clusters,
                           void *work, const t3r_cluster_host *host)
{
    const uint32_t batches =
        settings->follows ? (settings->batches + FOLLOW_PART - 1) / FOLLOW_PART : settings->batches;
    const uint32_t total = batches + source->points / T3R_CLUSTER_BATCH;
    means_job job = {.kernels = settings->kernels, .source = source, .host = host, .count = settings->clusters};
    cut_work(&job, work);
    if (!settings->follows && !place_centres(&job, settings, clusters, total)) {
        return T3R_CLUSTERS_CANCELLED;
    }
    for (uint32_t batch = 0; batch < batches; batch++) {
        if (!t3r_cluster_step(host, batch, total)) {
            return T3R_CLUSTERS_CANCELLED;
        }
        const bool follows = settings->follows && batch == 0;
        if (follows && !follow_centres(&job, settings, clusters, total)) {
            return T3R_CLUSTERS_CANCELLED;
        }
        if (!follows) {
            run_batch(&job, batch, clusters);
        }
    }
    return assign(&job, clusters, batches, total);
}
