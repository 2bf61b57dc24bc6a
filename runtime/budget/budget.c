/* SPDX-License-Identifier: Apache-2.0 */
#include "budget.h"

#include "budget_keys.h"
#include "core/fixed.h"
#include "core/logarithm.h"
#include "core/memory.h"
#include "importance.h"
#include "quotas.h"

/* A task that counts the points of a view's rows by group. */
typedef struct count_job {
    const t3r_kernels *kernels;
    const t3r_view *view;
    const t3r_budget_settings *settings;
    t3r_cluster *clusters;
    t3r_group_count *counts; /* one per group and worker */
    uint32_t shift;          /* of the key digit that is counted */
} count_job;

#define NO_GROUP UINT32_MAX

/* Maps pixels to groups: to their SuperCluster, or to cluster 0 for all points; deferred pixels to the group after the
 * last SuperCluster; pixels without depth to none. */
typedef struct grouping {
    uint32_t deferred; /* the group after the last SuperCluster */
    uint32_t labels;   /* all bits set if labels count, else 0 */
    uint8_t deferring; /* marks of deferred points */
} grouping;

static bool by_cluster(const t3r_budget_settings *settings)
{
    return t3r_allocates(settings, T3R_ALLOCATE_DENSITY) || t3r_allocates(settings, T3R_ALLOCATE_PAPER);
}

static inline grouping grouping_of(const t3r_budget_settings *settings)
{
    return (grouping){settings->clusters, by_cluster(settings) ? UINT32_MAX : 0, t3r_deferring_marks(settings)};
}

static inline uint32_t group_of(const t3r_view *view, size_t pixel, const grouping *groups)
{
    const uint8_t validity = view->validity[pixel];
    if (!t3r_has_depth(validity)) {
        return NO_GROUP;
    }
    return (validity & groups->deferring) != 0 ? groups->deferred : t3r_label_of(view, pixel) & groups->labels;
}

/* Clears the counts and runs a counting step over all views. */
static void count_groups(const t3r_view *views, uint32_t count, count_job *job, const t3r_workers *workers,
                         t3r_rows_task *rows)
{
    memset(job->counts, 0, (size_t)workers->count * (job->settings->clusters + 1) * sizeof *job->counts);
    for (uint32_t v = 0; v < count; v++) {
        job->view = &views[v];
        t3r_run_rows(workers, views[v].height, rows, job);
    }
}

static t3r_group_count *counts_of(const count_job *job, uint32_t worker)
{
    return job->counts + (size_t)worker * (job->settings->clusters + 1);
}

/* Counts points by the digit of their key at `shift`, where the higher digits equal those of their group's
 * threshold. */
static void count_digits(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    const count_job *job = context;
    const t3r_view view = *job->view;
    const grouping groups = grouping_of(job->settings);
    const t3r_cluster *clusters = job->clusters;
    const uint32_t shift = job->shift;
    t3r_group_count *counts = counts_of(job, worker);
    for (size_t i = (size_t)begin * view.width; i < (size_t)end * view.width; i++) {
        const uint32_t g = group_of(&view, i, &groups), key = view.key[i];
        if (g != NO_GROUP && ((key ^ clusters[g].threshold) >> shift >> T3R_KEY_DIGIT_BITS) == 0) {
            counts[g].of.digit[key >> shift & (T3R_KEY_DIGITS - 1)]++;
        }
    }
}

/* Chooses the largest digit below which fewer points lie than the group still needs, and the number needed from that
 * digit on. */
static void choose_digit(const count_job *job, uint32_t g, uint32_t workers)
{
    t3r_cluster *group = &job->clusters[g];
    uint32_t digit = 0, below = 0;
    for (uint32_t d = 0; d + 1 < T3R_KEY_DIGITS; d++) {
        uint32_t next = below;
        for (uint32_t w = 0; w < workers; w++) {
            next += counts_of(job, w)[g].of.digit[d];
        }
        if (next >= group->ties) {
            break;
        }
        digit = d + 1;
        below = next;
    }
    group->threshold += digit << job->shift;
    group->ties -= below; /* `below` is less than that, or 0 */
}

/* Finds each group's threshold, the largest key below which fewer than `quota` points lie, digit by digit for all
 * groups at once. `ties` becomes the number of points to retain at the threshold itself. */
static void find_thresholds(const t3r_view *views, uint32_t count, const t3r_budget_settings *settings,
                            t3r_cluster *clusters, const t3r_budget_work *work)
{
    const uint32_t groups = settings->clusters + 1;
    count_job job = {.settings = settings, .clusters = clusters, .counts = work->counts};
    for (uint32_t g = 0; g < groups; g++) {
        clusters[g].threshold = 0;
        clusters[g].ties = clusters[g].quota;
    }
    for (job.shift = 16; job.shift > 0;) {
        job.shift -= T3R_KEY_DIGIT_BITS;
        count_groups(views, count, &job, &work->workers, count_digits);
        for (uint32_t g = 0; g < groups; g++) {
            choose_digit(&job, g, work->workers.count);
        }
    }
}

/* Returns log2 of the share of points retained around a pixel, Q10, at a group density of `density_q10`: at most all,
 * at least the sure points. */
static int32_t local_density_q10(int32_t density_q10, int32_t wanted_q10)
{
    return t3r_clamp32(density_q10 + wanted_q10, T3R_LEAST_DENSITY_Q10, 0);
}

static void expect_points(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    const count_job *job = context;
    const t3r_view view = *job->view;
    const grouping groups = grouping_of(job->settings);
    const t3r_cluster *clusters = job->clusters;
    t3r_group_count *counts = counts_of(job, worker);
    for (size_t at = (size_t)begin * view.width; at < (size_t)end * view.width; at += T3R_KEY_RUN) {
        const uint32_t run = (uint32_t)T3R_MIN((size_t)T3R_KEY_RUN, (size_t)end * view.width - at);
        uint16_t wanted_q10[T3R_KEY_RUN];
        t3r_find_wanted(job->settings, job->kernels, view.texture + at, run, wanted_q10);
        for (uint32_t i = 0; i < run; i++) {
            const uint32_t g = group_of(&view, at + i, &groups);
            if (g < groups.deferred) {
                counts[g].of.expected_q16 += t3r_exp2_of_q10(local_density_q10(clusters[g].density_q10, wanted_q10[i]));
            }
        }
    }
}

/* Estimates the density of each group at which its pixels' shares sum to its quota. The threshold, the key of one
 * point, is a noisy measure of it in small groups, so two rounds of proportional correction follow. */
static void estimate_densities(const t3r_view *views, uint32_t count, const t3r_budget_settings *settings,
                               t3r_cluster *clusters, const t3r_budget_work *work)
{
    count_job job = {.kernels = work->kernels, .settings = settings, .clusters = clusters, .counts = work->counts};
    for (uint32_t g = 0; g < settings->clusters; g++) {
        clusters[g].density_q10 = (int32_t)clusters[g].threshold - T3R_KEY_ZERO;
    }
    for (int round = 0; round < 2; round++) {
        count_groups(views, count, &job, &work->workers, expect_points);
        for (uint32_t g = 0; g < settings->clusters; g++) {
            uint64_t expected_q16 = 0;
            for (uint32_t w = 0; w < work->workers.count; w++) {
                expected_q16 += counts_of(&job, w)[g].of.expected_q16;
            }
            if (clusters[g].quota > 0 && expected_q16 > 0) {
                int32_t log_ratio_q16 =
                    t3r_log2_wide_q16((uint64_t)clusters[g].quota << 16) - t3r_log2_wide_q16(expected_q16);
                clusters[g].density_q10 += t3r_round_shift32(log_ratio_q16, 6);
            }
        }
    }
}

/* Sets the masks. Ties go to the first points in the order of views and rows, so this is sequential. */
static void set_masks(const t3r_view *views, uint32_t count, const t3r_budget_settings *settings, t3r_cluster *clusters)
{
    const grouping groups = grouping_of(settings);
    for (uint32_t v = 0; v < count; v++) {
        const t3r_view *view = &views[v];
        size_t pixels = (size_t)view->width * view->height;
        memset(view->mask, 0, (pixels + 31) / 32 * sizeof *view->mask);
        for (size_t i = 0; i < pixels; i++) {
            uint32_t g = group_of(view, i, &groups);
            if (g == NO_GROUP) {
                continue;
            }
            t3r_cluster *group = &clusters[g];
            bool tie = view->key[i] == group->threshold && group->ties > 0;
            group->ties -= tie;
            if (view->key[i] < group->threshold || tie) {
                view->mask[i / 32] |= 1u << (i % 32);
            }
        }
    }
}

bool t3r_is_sparse(const t3r_view *views, uint32_t count, uint32_t gaussians)
{
    uint64_t plain = 0;
    for (uint32_t v = 0; v < count; v++) {
        size_t pixels = (size_t)views[v].width * views[v].height;
        for (size_t i = 0; i < pixels; i++) {
            uint8_t validity = views[v].validity[i];
            plain += t3r_has_depth(validity) && !t3r_is_doubtful(validity) && !t3r_is_covered(validity);
        }
    }
    return 3 * (uint64_t)gaussians <= 2 * plain;
}

/* Counts the points that this budget defers: by cluster, and all of them in the group after the last one. */
static void count_deferred(const t3r_view *views, uint32_t count, const t3r_budget_settings *settings,
                           t3r_cluster *clusters)
{
    t3r_cluster *all = &clusters[settings->clusters];
    *all = (t3r_cluster){0};
    for (uint32_t k = 0; k < settings->clusters; k++) {
        clusters[k].deferred = 0;
    }
    for (uint32_t v = 0; v < count; v++) {
        size_t pixels = (size_t)views[v].width * views[v].height;
        for (size_t i = 0; i < pixels; i++) {
            if (t3r_has_depth(views[v].validity[i]) && t3r_is_deferred(&views[v], i, settings)) {
                clusters[t3r_label_of(&views[v], i)].deferred++;
                all->points++;
            }
        }
    }
}

void t3r_allocate(const t3r_view *views, uint32_t count, const t3r_budget_settings *settings, t3r_cluster *clusters,
                  const t3r_budget_work *work)
{
    count_deferred(views, count, settings, clusters);
    t3r_set_quotas(clusters, settings);
    const bool given = t3r_allocates(settings, T3R_ALLOCATE_GIVEN);
    if (!given) {
        t3r_budget_keys(views, count, settings, work);
    }
    find_thresholds(views, count, settings, clusters, work);
    if (!given) {
        estimate_densities(views, count, settings, clusters, work);
    }
    set_masks(views, count, settings, clusters);
    if (given) {
        t3r_count_shares(views, count, clusters, settings->clusters);
    }
}

void t3r_retain_below(const t3r_view *view, const t3r_budget_settings *settings, uint32_t threshold, uint32_t ties,
                      t3r_cluster *clusters)
{
    clusters[0].threshold = threshold;
    clusters[0].ties = ties;
    clusters[0].density_q10 = (int32_t)threshold - T3R_KEY_ZERO;
    clusters[settings->clusters] = (t3r_cluster){0};
    set_masks(view, 1, settings, clusters);
}

int32_t t3r_log_density_q10(const t3r_view *view, size_t pixel, const t3r_budget_settings *settings,
                            const t3r_cluster *clusters)
{
    const grouping groups = grouping_of(settings);
    uint32_t g = group_of(view, pixel, &groups);
    if (g >= settings->clusters) {
        return 0; /* it is retained only if all others are, so it covers nothing else */
    }
    if (t3r_allocates(settings, T3R_ALLOCATE_GIVEN)) {
        return t3r_log_share_q10(view, pixel, clusters);
    }
    const t3r_cluster *group = &clusters[g];
    return local_density_q10(group->density_q10, t3r_log_wanted_q10(view->texture[pixel], settings));
}
