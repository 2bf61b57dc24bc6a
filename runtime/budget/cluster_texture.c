#include "cluster_texture.h"

#include "core/fixed.h"

/* Rows of a view being blurred. */
typedef struct blur_job {
    const t3r_kernels *kernels;
    const t3r_view *view;
} blur_job;

/* The 5-box applied twice: weights 1 2 3 4 5 4 3 2 1 of 25; variance 4 px^2. The edge repeats beyond the border. */
static void blur_across(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const blur_job *job = context;
    const t3r_view *view = job->view;
    for (uint32_t y = begin; y < end; y++) {
        const size_t at = (size_t)y * view->width;
        job->kernels->blur_row(view->texture + at, view->width, view->key + at);
    }
}

static void blur_down(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const blur_job *job = context;
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
        blur_job job = {.kernels = kernels, .view = &views[v]};
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
    /* Fisher-Yates: the entry drawn is at or before its new place */
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
        /* ascending without ties: each is there exactly once */
        if (clusters[i].order >= cluster_count ||
            (i > 0 && !precedes(clusters, clusters[i - 1].order, clusters[i].order))) {
            return false;
        }
    }
    return true;
}
