#include "budget.h"

#include "blue_noise.h"
#include "core/fixed.h"
#include "core/logarithm.h"
#include "core/memory.h"
#include "importance.h"

/* --- texture ---------------------------------------------------------------------------------------------------- */

/* A step over the rows of one view, and whatever it needs. */
typedef struct rows_of_view {
    const t3r_kernels *kernels;
    const t3r_view *view;
    uint32_t number; /* of the view */
    const t3r_budget_settings *settings;
    t3r_cluster *clusters;
    t3r_group_count *counts; /* of each group, for each worker */
    uint32_t shift;          /* of the digit of keys that is counted */
} rows_of_view;

/* The 5-box twice: weights 1 2 3 4 5 4 3 2 1 of 25; variance 4 px^2. Beyond the border the edge repeats. */
static void blur_across(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const rows_of_view *job = context;
    const t3r_view *view = job->view;
    for (uint32_t y = begin; y < end; y++) {
        const size_t at = (size_t)y * view->width;
        job->kernels->blur_row(view->texture + at, view->width, view->key + at);
    }
}

static void blur_down(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const rows_of_view *job = context;
    const t3r_view *view = job->view;
    for (uint32_t y = begin; y < end; y++) {
        const uint16_t *rows[T3R_BLUR_TAPS];
        for (int32_t tap = 0; tap < T3R_BLUR_TAPS; tap++) {
            int32_t row = t3r_clamp32((int32_t)y + tap - T3R_BLUR_REACH, 0, (int32_t)view->height - 1);
            rows[tap] = view->key + (size_t)row * view->width;
        }
        job->kernels->blur_column(rows, view->width, view->texture + (size_t)y * view->width);
    }
}

void t3r_blur_texture(const t3r_kernels *kernels, const t3r_view *views, uint32_t count, const t3r_workers *workers)
{
    for (uint32_t v = 0; v < count; v++) {
        rows_of_view job = {.kernels = kernels, .view = &views[v]};
        t3r_run_rows(workers, views[v].height, blur_across, &job);
        t3r_run_rows(workers, views[v].height, blur_down, &job);
    }
}

static bool precedes(const t3r_cluster *clusters, uint32_t a, uint32_t b)
{
    return clusters[a].texture_q4 < clusters[b].texture_q4 ||
           (clusters[a].texture_q4 == clusters[b].texture_q4 && a < b);
}

void t3r_cluster_texture(const t3r_view *views, uint32_t count, t3r_cluster *clusters, uint32_t cluster_count)
{
    uint64_t sums[T3R_MAX_CLUSTERS] = {0};
    for (uint32_t v = 0; v < count; v++) {
        size_t pixels = (size_t)views[v].width * views[v].height;
        for (size_t i = 0; i < pixels; i++) {
            if (t3r_has_depth(views[v].validity[i])) {
                sums[t3r_label_of(&views[v], i)] += views[v].texture[i];
            }
        }
    }
    for (uint32_t k = 0; k < cluster_count; k++) {
        uint32_t points = clusters[k].points;
        clusters[k].texture_q4 = points == 0 ? 0 : (uint32_t)((sums[k] + points / 2) / points);
    }
}

void t3r_shuffle_texture(t3r_cluster *clusters, uint32_t cluster_count, uint32_t seed)
{
    uint16_t filled[T3R_MAX_CLUSTERS];
    uint32_t count = 0;
    for (uint32_t k = 0; k < cluster_count; k++) {
        if (clusters[k].points > 0) {
            filled[count++] = (uint16_t)k;
        }
    }
    /* Fisher and Yates: what is drawn lies at or before the place it comes to */
    for (uint32_t i = count; i > 1; i--) {
        t3r_cluster *last = &clusters[filled[i - 1]];
        t3r_cluster *drawn = &clusters[filled[t3r_mix32(i ^ t3r_mix32(seed)) % i]];
        uint32_t texture_q4 = last->texture_q4;
        last->texture_q4 = drawn->texture_q4;
        drawn->texture_q4 = texture_q4;
    }
}

void t3r_rank_clusters(t3r_cluster *clusters, uint32_t cluster_count)
{
    /* Insertion sort: at most K^2 / 2 steps, K <= 512. */
    for (uint32_t i = 0; i < cluster_count; i++) {
        clusters[i].order = i;
    }
    for (uint32_t i = 1; i < cluster_count; i++) {
        uint32_t moved = clusters[i].order, place = i;
        while (place > 0 && precedes(clusters, moved, clusters[place - 1].order)) {
            clusters[place].order = clusters[place - 1].order;
            place--;
        }
        clusters[place].order = moved;
    }
}

bool t3r_are_ranked(const t3r_cluster *clusters, uint32_t cluster_count)
{
    for (uint32_t i = 0; i < cluster_count; i++) {
        /* ascending without ties: then each is there once */
        if (clusters[i].order >= cluster_count ||
            (i > 0 && !precedes(clusters, clusters[i - 1].order, clusters[i].order))) {
            return false;
        }
    }
    return true;
}

/* --- keys --------------------------------------------------------------------------------------------------------- */

static bool follows_texture(const t3r_budget_settings *settings)
{
    return !T3R_FEATURE_ALLOCATIONS || t3r_allocates(settings, T3R_ALLOCATE_DENSITY) ||
           t3r_allocates(settings, T3R_ALLOCATE_PIXEL);
}

static bool by_cluster(const t3r_budget_settings *settings)
{
    return t3r_allocates(settings, T3R_ALLOCATE_DENSITY) || t3r_allocates(settings, T3R_ALLOCATE_PAPER);
}

/* gamma log2(texture + floor), at most 32 */
int32_t t3r_log_wanted_q10(uint16_t texture_q4, const t3r_budget_settings *settings)
{
    if (!follows_texture(settings)) {
        return 0;
    }
    int64_t log_q16 = t3r_log2_q16((uint32_t)texture_q4 + T3R_TEXTURE_FLOOR_Q4);
    return (int32_t)t3r_round_shift64(log_q16 * settings->gamma_q8, 14);
}

/* gamma log2(texture + floor) of a run. */
static void find_wanted(const rows_of_view *job, const uint16_t *texture_q4, uint32_t count, uint16_t *wanted_q10)
{
    if (follows_texture(job->settings)) {
        job->kernels->wanted_row(texture_q4, count, job->settings->gamma_q8, wanted_q10);
    } else {
        memset(wanted_q10, 0, count * sizeof *wanted_q10);
    }
}

/* The ranks of the blue noise in a row of the view. Each view sees the map shifted, so that two views of a surface
 * complement each other. */
static void find_ranks(uint32_t view, uint32_t y, uint16_t rank[T3R_BLUE_NOISE_SIDE])
{
    const uint32_t row = (y + 23 * view) % T3R_BLUE_NOISE_SIDE;
    for (uint32_t x = 0; x < T3R_BLUE_NOISE_SIDE; x++) {
        rank[x] = (uint16_t)t3r_blue_noise(row, (x + 46 * view) % T3R_BLUE_NOISE_SIDE);
    }
}

/* Of the points that are retained last, among these the doubtful ones at the very end. */
static void defer_row(const rows_of_view *job, size_t at, uint32_t count)
{
    const uint8_t deferring = t3r_deferring_marks(job->settings);
    const uint8_t *validity = job->view->validity + at;
    uint16_t *key = job->view->key + at;
    for (uint32_t x = 0; x < count; x++) {
        const uint16_t deferred = (uint16_t)((key[x] >> 1) | (t3r_is_doubtful(validity[x]) ? 0x8000u : 0));
        key[x] = (validity[x] & deferring) != 0 ? deferred : key[x];
    }
}

/* Thresholds are blue noise, whose 4,096 ranks are split by white noise, or white noise alone. */
static void key_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const rows_of_view *job = context;
    const t3r_view *view = job->view;
    const uint32_t number = job->settings->shift + job->number, seed = t3r_mix32(job->settings->seed);
    const bool is_white = t3r_allocates(job->settings, T3R_ALLOCATE_RANDOM);
    for (uint32_t y = begin; y < end; y++) {
        uint16_t rank[T3R_BLUE_NOISE_SIDE], wanted_q10[T3R_KEY_RUN];
        find_ranks(number, y, rank);
        const size_t at = (size_t)y * view->width;
        for (uint32_t x = 0; x < view->width; x += T3R_KEY_RUN) {
            const uint32_t count = T3R_MIN(T3R_KEY_RUN, view->width - x);
            find_wanted(job, view->texture + at + x, count, wanted_q10);
            job->kernels->key_row((number << 26) ^ (y << 13) ^ x, seed, is_white ? NULL : rank, wanted_q10, count,
                                  view->key + at + x);
        }
        defer_row(job, at, view->width);
    }
}

void t3r_budget_keys(const t3r_view *views, uint32_t count, const t3r_budget_settings *settings,
                     const t3r_budget_work *work)
{
    for (uint32_t v = 0; v < count; v++) {
        rows_of_view job = {.kernels = work->kernels, .view = &views[v], .number = v, .settings = settings};
        t3r_run_rows(&work->workers, views[v].height, key_rows, &job);
    }
}

/* --- quotas ------------------------------------------------------------------------------------------------------- */

/* Those of a cluster's points that are there to be retained. */
static inline uint32_t open_points(const t3r_cluster *cluster)
{
    return cluster->points - T3R_MIN(cluster->deferred, cluster->points);
}

/* Weights sum to less than this, points times a factor: sums that count more are held there. */
#define WEIGHTS_MOST (((uint64_t)1 << 39) - 1)

static uint64_t add_weight(uint64_t sum, uint64_t weight)
{
    return T3R_MIN(sum + T3R_MIN(weight, WEIGHTS_MOST), WEIGHTS_MOST);
}

/* Shares `budget`, at most 2^24, among the clusters in proportion to weight[k]; cumulative rounding makes the sum exact
 * and each quota one of the two integers next to its share. Whatever the weights, the sum is at most the budget. */
static void share_out(t3r_cluster *clusters, uint32_t count, const uint64_t *weight, uint64_t budget)
{
    uint64_t total = 0, running = 0, given = 0;
    for (uint32_t k = 0; k < count; k++) {
        total = add_weight(total, weight[k]);
    }
    for (uint32_t k = 0; k < count && total > 0; k++) {
        if (weight[k] > 0) {
            running = add_weight(running, weight[k]);
            uint64_t due = running * budget / total; /* `running` is at most `total`, and below 2^39 */
            clusters[k].quota = (uint32_t)(due - given);
            given = due;
        }
    }
}

/* `density`: in proportion to |SC| x Texture(SC)^gamma, no cluster more than its points. A cluster whose share would
 * exceed its points gets them all and leaves the rest to the others: at most K rounds, a few in practice. */
static void quotas_by_density(t3r_cluster *clusters, uint32_t count, const t3r_budget_settings *settings,
                              uint64_t budget)
{
    uint64_t weight[T3R_MAX_CLUSTERS]; /* points x factor: below 2^28 x 2^10, 2^38 in sum */
    uint32_t factor_q10[T3R_MAX_CLUSTERS];
    int32_t most = 0;
    for (uint32_t k = 0; k < count; k++) {
        most = T3R_MAX(most, t3r_log_wanted_q10((uint16_t)clusters[k].texture_q4, settings));
    }
    for (uint32_t k = 0; k < count; k++) {
        int32_t below = t3r_log_wanted_q10((uint16_t)clusters[k].texture_q4, settings) - most;
        factor_q10[k] = below <= -(10 << 10) ? 1 : t3r_exp2_q16(below * 64) >> 6; /* at least 1 there, too */
        weight[k] = (uint64_t)open_points(&clusters[k]) * factor_q10[k];
    }
    for (uint32_t round = 0; round < count; round++) {
        uint64_t total = 0, taken = 0;
        for (uint32_t k = 0; k < count; k++) {
            total += weight[k];
        }
        for (uint32_t k = 0; k < count; k++) {
            /* weight budget / total >= points, divided by points */
            if (weight[k] > 0 && factor_q10[k] * budget >= total) {
                clusters[k].quota = open_points(&clusters[k]);
                taken += open_points(&clusters[k]);
                weight[k] = 0;
            }
        }
        if (taken == 0) {
            break;
        }
        budget -= T3R_MIN(taken, budget);
    }
    share_out(clusters, count, weight, budget);
}

/* `paper`: from the lowest texture up each cluster keeps N % of its points until Z is met; the last is cut so that Z is
 * exact; if Z is below N % of all, N becomes Z / valid for all. */
static void quotas_by_paper(t3r_cluster *clusters, uint32_t count, const t3r_budget_settings *settings, uint64_t budget,
                            uint64_t valid)
{
    uint64_t left = valid;
    for (uint32_t k = 0; k < count; k++) {
        clusters[k].quota = open_points(&clusters[k]);
    }
    for (uint32_t i = 0; i < count && left > budget; i++) {
        t3r_cluster *cluster = &clusters[clusters[i].order];
        uint64_t kept = ((uint64_t)open_points(cluster) * settings->keep_percent + 50) / 100;
        uint64_t dropped = T3R_MIN(open_points(cluster) - kept, left - budget);
        cluster->quota = (uint32_t)(open_points(cluster) - dropped);
        left -= dropped;
    }
    if (left > budget) {
        uint64_t weight[T3R_MAX_CLUSTERS];
        for (uint32_t k = 0; k < count; k++) {
            weight[k] = open_points(&clusters[k]);
        }
        share_out(clusters, count, weight, budget);
    }
}

/* A group never retains more than its quota, nor all groups more than Z: the scene has room for no more. */
static void hold_quotas(t3r_cluster *clusters, uint32_t groups, uint32_t most)
{
    for (uint32_t g = 0; g < groups; g++) {
        clusters[g].quota = T3R_MIN(clusters[g].quota, most);
        most -= clusters[g].quota;
    }
}

/* --- selection ---------------------------------------------------------------------------------------------------- */

#define NO_GROUP UINT32_MAX

/* The groups of pixels by settings: a pixel falls under the quota of its SuperCluster, or of cluster 0 standing for all
 * points; a deferred one under that of the group behind the last SuperCluster, and one without depth under none. */
typedef struct grouping {
    uint32_t deferred; /* the group behind the last SuperCluster */
    uint32_t labels;   /* ones where labels count, else 0 */
    uint8_t deferring; /* marks */
} grouping;

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

/* Runs a step that counts by group over all views, from 0. */
static void count_groups(const t3r_view *views, uint32_t count, rows_of_view *job, const t3r_workers *workers,
                         t3r_rows_task *rows)
{
    memset(job->counts, 0, (size_t)workers->count * (job->settings->clusters + 1) * sizeof *job->counts);
    for (uint32_t v = 0; v < count; v++) {
        job->view = &views[v];
        t3r_run_rows(workers, views[v].height, rows, job);
    }
}

static t3r_group_count *counts_of(const rows_of_view *job, uint32_t worker)
{
    return job->counts + (size_t)worker * (job->settings->clusters + 1);
}

/* Points by the digit of their key at `shift`, where the digits above are those of their group's threshold. */
static void count_digits(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    const rows_of_view *job = context;
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

/* The largest digit below which fewer points lie than the group still wants, and what it wants from that digit on. */
static void choose_digit(const rows_of_view *job, uint32_t g, uint32_t workers)
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
    group->ties -= below; /* fewer than these, or none */
}

/* Finds each group's threshold, the largest key below which fewer than `quota` points lie, digit by digit of all groups
 * at once; and how many points at the threshold itself are wanted. */
static void find_thresholds(const t3r_view *views, uint32_t count, const t3r_budget_settings *settings,
                            t3r_cluster *clusters, const t3r_budget_work *work)
{
    const uint32_t groups = settings->clusters + 1;
    rows_of_view job = {.settings = settings, .clusters = clusters, .counts = work->counts};
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

/* log2 of the share of points retained about a pixel, Q10, if its group's density were `density_q10`: at most all, and
 * at least the sure ones. */
static int32_t local_density_q10(int32_t density_q10, int32_t wanted_q10)
{
    return t3r_clamp32(density_q10 + wanted_q10, T3R_LEAST_DENSITY_Q10, 0);
}

static void expect_points(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    const rows_of_view *job = context;
    const t3r_view view = *job->view;
    const grouping groups = grouping_of(job->settings);
    const t3r_cluster *clusters = job->clusters;
    t3r_group_count *counts = counts_of(job, worker);
    for (size_t at = (size_t)begin * view.width; at < (size_t)end * view.width; at += T3R_KEY_RUN) {
        const uint32_t run = (uint32_t)T3R_MIN((size_t)T3R_KEY_RUN, (size_t)end * view.width - at);
        uint16_t wanted_q10[T3R_KEY_RUN];
        find_wanted(job, view.texture + at, run, wanted_q10);
        for (uint32_t i = 0; i < run; i++) {
            const uint32_t g = group_of(&view, at + i, &groups);
            if (g < groups.deferred) {
                counts[g].of.expected_q16 += t3r_exp2_of_q10(local_density_q10(clusters[g].density_q10, wanted_q10[i]));
            }
        }
    }
}

/* The density of each group for which its pixels' shares sum to its quota. The threshold alone, the key of one point,
 * is a noisy measure of it in small groups; two rounds of proportional correction from there settle it. */
static void estimate_densities(const t3r_view *views, uint32_t count, const t3r_budget_settings *settings,
                               t3r_cluster *clusters, const t3r_budget_work *work)
{
    rows_of_view job = {.kernels = work->kernels, .settings = settings, .clusters = clusters, .counts = work->counts};
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

/* Ties go to the first points in the order of views and rows: one after the other. */
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

/* The points that this budget defers: of each cluster, and all as a group of their own behind the last. */
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
    uint64_t valid = 0;
    for (uint32_t k = 0; k < settings->clusters; k++) {
        valid += open_points(&clusters[k]);
        clusters[k].quota = 0;
    }
    uint64_t budget = T3R_MIN(settings->gaussians, valid);
    if (t3r_allocates(settings, T3R_ALLOCATE_DENSITY)) {
        quotas_by_density(clusters, settings->clusters, settings, budget);
    } else if (t3r_allocates(settings, T3R_ALLOCATE_PAPER)) {
        quotas_by_paper(clusters, settings->clusters, settings, budget, valid);
    } else {
        clusters[0].quota = (uint32_t)budget;
    }
    t3r_cluster *deferred = &clusters[settings->clusters];
    deferred->quota = (uint32_t)T3R_MIN(settings->gaussians - budget, deferred->points);
    hold_quotas(clusters, settings->clusters + 1, settings->gaussians);
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

int32_t t3r_log_density_q10(const t3r_view *view, size_t pixel, const t3r_budget_settings *settings,
                            const t3r_cluster *clusters)
{
    const grouping groups = grouping_of(settings);
    uint32_t g = group_of(view, pixel, &groups);
    if (g >= settings->clusters) {
        return 0; /* retained where all others are, so that nothing about it is left for it to cover */
    }
    if (t3r_allocates(settings, T3R_ALLOCATE_GIVEN)) {
        return t3r_log_share_q10(view, pixel, clusters);
    }
    const t3r_cluster *group = &clusters[g];
    return local_density_q10(group->density_q10, t3r_log_wanted_q10(view->texture[pixel], settings));
}
