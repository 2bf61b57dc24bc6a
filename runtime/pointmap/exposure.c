#include "exposure.h"

#include <stdbool.h>

#include "core/fixed.h"
#include "core/memory.h"
#include "reproject.h"

#define STEP 2 /* pixels */
#define LEVEL_LEAST 16
#define LEVEL_MOST 239
#define PAIRS_LEAST 256
#define BINS 512 /* log2 of a ratio in Q8, -1..1 */

/* The ratios of a view's levels to those of the views before it. */
typedef struct ratios {
    uint32_t bin[3][BINS];
    uint32_t count;
} ratios;

static bool well_exposed(const t3r_view *view, size_t pixel)
{
    for (int c = 0; c < 3; c++) {
        if (view->colour[c][pixel] < LEVEL_LEAST || view->colour[c][pixel] > LEVEL_MOST) {
            return false;
        }
    }
    return true;
}

static bool is_pair(const t3r_pointmap *from, size_t pixel, const t3r_pointmap *to,
                    const t3r_projected_pixel *projected)
{
    if (!t3r_is_reliable(to->view->validity[projected->pixel])) {
        return false;
    }
    int32_t there = t3r_depth_q20(to->scale, to->view->depth[projected->pixel]);
    return 64 * t3r_abs64((int64_t)projected->z_q20 - there) <= T3R_MIN(projected->z_q20, there) &&
           well_exposed(from->view, pixel) && well_exposed(to->view, projected->pixel);
}

/* Levels of `from` over those of `to`, whose own are level_q8 above the first view's. */
static void compare(const t3r_pointmap *from, const t3r_pointmap *to, const int32_t level_q8[3], ratios *r)
{
    const t3r_view *view = from->view;
    for (uint32_t y = 0; y < view->height; y += STEP) {
        for (uint32_t x = 0; x < view->width; x += STEP) {
            size_t pixel = (size_t)y * view->width + x;
            t3r_projected_pixel projected;
            if (!t3r_is_reliable(view->validity[pixel]) || !t3r_reproject(from, x, y, to, &projected) ||
                !is_pair(from, pixel, to, &projected)) {
                continue;
            }
            for (int c = 0; c < 3; c++) {
                int32_t log_q16 =
                    t3r_log2_q16(view->colour[c][pixel]) - t3r_log2_q16(to->view->colour[c][projected.pixel]);
                r->bin[c][t3r_clamp32(t3r_round_shift32(log_q16, 8) + level_q8[c] + BINS / 2, 0, BINS - 1)]++;
            }
            r->count++;
        }
    }
}

/* The least ratio that at least half of the pairs do not exceed, log2 in Q8 */
static int32_t median_q8(const uint32_t bin[BINS], uint32_t count)
{
    uint32_t sum = 0;
    for (int32_t i = 0; i < BINS - 1; i++) {
        sum += bin[i];
        if (2 * (uint64_t)sum >= count) {
            return i - BINS / 2;
        }
    }
    return BINS / 2 - 1;
}

uint32_t t3r_exposure_gains(const t3r_view *views, uint32_t count, int32_t exponent, uint16_t gain_q14[][3])
{
    int32_t level_q8[T3R_MAX_VIEWS][3] = {{0}};
    int32_t sum_q8[3] = {0};
    bool linked[T3R_MAX_VIEWS] = {true};
    int32_t links = 1;
    for (uint32_t v = 1; v < count; v++) {
        ratios r;
        memset(&r, 0, sizeof r);
        t3r_pointmap from = t3r_pointmap_of(&views[v], exponent);
        for (uint32_t w = 0; w < v; w++) {
            if (linked[w]) {
                t3r_pointmap to = t3r_pointmap_of(&views[w], exponent);
                compare(&from, &to, level_q8[w], &r);
            }
        }
        linked[v] = r.count >= PAIRS_LEAST;
        links += linked[v];
        for (int c = 0; c < 3 && linked[v]; c++) {
            level_q8[v][c] = median_q8(r.bin[c], r.count);
            sum_q8[c] += level_q8[v][c];
        }
    }
    for (uint32_t v = 0; v < count; v++) {
        for (int c = 0; c < 3; c++) {
            int32_t mean_q8 = (int32_t)t3r_round_div64(sum_q8[c], links);
            int32_t over = linked[v] ? level_q8[v][c] - mean_q8 : 0; /* at most 2 octaves either way */
            int32_t gain = t3r_round_shift32((int32_t)t3r_exp2_q16(-over * 256), 2);
            gain_q14[v][c] = (uint16_t)T3R_MIN(gain, (int32_t)UINT16_MAX);
        }
    }
    return (uint32_t)links;
}
