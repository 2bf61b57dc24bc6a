/* SPDX-License-Identifier: Apache-2.0 */
/* Tile lists. Each task counts or fills a band of tiles. It reads the tile span of every splat, four bytes each in
 * depth order, and takes the splats in its band. */
#include "core/fixed.h"
#include "raster_tile.h"

/* Minimum number of splats in a band: one worker finishes fewer before another has started. */
#define SPLATS_A_BAND 4096u

typedef struct bin_job {
    const t3r_binning *bin;
    uint32_t begin, end; /* rows of tiles when counting, tiles when filling lists */
    uint32_t bands;
} bin_job;

static void run_bands(const t3r_workers *workers, bin_job *job, t3r_task *task)
{
    const uint32_t most = t3r_is_parallel(workers) ? workers->count : 1;
    job->bands = T3R_MIN(most, T3R_MIN(job->end - job->begin, job->bin->visible / SPLATS_A_BAND + 1));
    t3r_run_tasks(workers, job->bands, task, job);
}

/* Counts by differences: adds 1 at x0 and subtracts 1 after x1, so a row of tiles takes two steps however wide a splat
 * is. */
static void count_band(void *context, uint32_t index, uint32_t worker)
{
    (void)worker;
    const bin_job *job = context;
    const t3r_binning *bin = job->bin;
    const uint32_t across = bin->across, visible = bin->visible;
    const t3r_tile_span *restrict spans = bin->spans;
    uint32_t *restrict table = bin->table;
    const t3r_share rows = t3r_share_of(job->end, index, job->bands);
    for (uint32_t tile = rows.begin * across; tile < rows.end * across; tile++) {
        table[tile] = 0;
    }
    for (uint32_t i = 0; i < visible; i++) {
        const t3r_tile_span span = spans[i];
        const uint32_t y0 = T3R_MAX(span.y0, rows.begin), y1 = T3R_MIN(span.y1 + 1u, rows.end);
        for (uint32_t y = y0; y < y1; y++) {
            uint32_t *row = table + y * across;
            row[span.x0]++;
            if (span.x1 + 1u < across) {
                row[span.x1 + 1]--; /* may wrap; the prefix sum is right again */
            }
        }
    }
    for (uint32_t y = rows.begin; y < rows.end; y++) {
        uint32_t *row = table + y * across;
        for (uint32_t x = 1; x < across; x++) {
            row[x] += row[x - 1];
        }
    }
}

void t3r_bin_count(const t3r_workers *workers, const t3r_binning *bin)
{
    bin_job job = {bin, 0, bin->tiles / bin->across, 0};
    run_bands(workers, &job, count_band);
}

/* Replaces the counts of the tiles that fit by the starts of their lists. Returns the first tile that doesn't fit. */
static uint32_t open_lists(const t3r_binning *bin, uint32_t first)
{
    uint64_t sum = 0;
    uint32_t end = first;
    while (end < bin->tiles && sum + bin->table[end] <= bin->capacity) {
        uint32_t count = bin->table[end];
        bin->table[end] = (uint32_t)sum;
        sum += count;
        end++;
    }
    return end;
}

static void fill_band(void *context, uint32_t index, uint32_t worker)
{
    (void)worker;
    const bin_job *job = context;
    const t3r_binning *bin = job->bin;
    const t3r_share tiles = t3r_share_of(job->end - job->begin, index, job->bands);
    const uint32_t across = bin->across, visible = bin->visible;
    const uint32_t first = job->begin + tiles.begin, last = job->begin + tiles.end - 1;
    const uint32_t first_row = first / across, first_column = first % across;
    const uint32_t last_row = last / across, last_column = last % across;
    const t3r_tile_span *restrict spans = bin->spans;
    const uint32_t *restrict order = bin->order;
    uint32_t *restrict table = bin->table, *restrict lists = bin->lists;
    for (uint32_t i = 0; i < visible; i++) {
        const t3r_tile_span span = spans[i];
        const uint32_t y0 = T3R_MAX(span.y0, first_row), y1 = T3R_MIN(span.y1, last_row);
        for (uint32_t y = y0; y <= y1; y++) {
            /* the first and the last row of a band may be part of a row of tiles */
            const uint32_t x0 = y == first_row ? T3R_MAX(span.x0, first_column) : span.x0;
            const uint32_t x1 = y == last_row ? T3R_MIN(span.x1, last_column) : span.x1;
            uint32_t *row = table + y * across;
            for (uint32_t x = x0; x <= x1; x++) {
                lists[row[x]++] = order[i];
            }
        }
    }
}

uint32_t t3r_bin_pass(const t3r_workers *workers, const t3r_binning *bin, uint32_t first)
{
    bin_job job = {bin, first, open_lists(bin, first), 0};
    run_bands(workers, &job, fill_band);
    return job.end;
}
