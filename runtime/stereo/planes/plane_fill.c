/* SPDX-License-Identifier: Apache-2.0 */
#include "plane_fill.h"

#include "core/cut.h"
#include "stereo/stereo.h"
#include "stereo/stereo_fill.h"

/* Sweeps over the picture: down, up, down, up. */
#define SWEEPS 4
/* Cost of a step to a neighbour, straight and diagonal, and of a level of luma on it. */
#define STRAIGHT 5
#define DIAGONAL 7
#define LEVEL 5
/* Initial cost of pixels on no plane, because most are wrong matches. */
#define STRAY 200
#define NO_PLANE T3R_PLANES_MOST
/* A plane bounds the room if it has 1/BOUND_SHARE of the matched pixels, and at most one pixel behind it for BOUND_ON
 * on it. */
#define BOUND_SHARE 10
#define BOUND_ON 8

/* A view being filled. */
typedef struct filling {
    const t3r_view *view;
    int32_t middle_x, middle_y;
    t3r_planes planes;
    uint32_t weight_q2[T3R_PLANES_MOST + 1]; /* of steps from pixels on each plane, and on none */
    bool bounds[T3R_PLANES_MOST];
    int64_t least_q8, most_q8; /* range of one over depth on planes */
    uint16_t *cost;            /* of the path; UINT16_MAX = none yet, or longer */
    uint8_t *plane, *luma;
} filling;

/* Counts of matched pixels: all, on each plane, and behind it. */
typedef struct tally {
    uint32_t matched, on[T3R_PLANES_MOST], behind[T3R_PLANES_MOST];
} tally;

static int64_t at_q8(const filling *f, uint32_t plane, uint32_t u, uint32_t v)
{
    return t3r_plane_at_q8(&f->planes.plane[plane], (int32_t)u - f->middle_x, (int32_t)v - f->middle_y);
}

/* Returns 1.5 times the search's tolerance, because its planes were fitted to few pixels. */
static int64_t within_q8(const filling *f)
{
    return f->planes.within_q8 + f->planes.within_q8 / 2;
}

static bool is_matched(const t3r_view *view, size_t i)
{
    return view->depth[i] != 0 && view->match_confidence[i] >= T3R_STEREO_LEAST;
}

/* Returns the nearest plane to a matched pixel if it lies on one; counts the planes in front of it. */
static uint8_t plane_of(const filling *f, uint32_t u, uint32_t v, int64_t inverse_q8, tally *c)
{
    int64_t least = within_q8(f) + 1;
    uint8_t nearest = NO_PLANE;
    for (uint32_t p = 0; p < f->planes.count; p++) {
        const int64_t off = inverse_q8 - at_q8(f, p, u, v);
        c->behind[p] += off < -within_q8(f);
        if (t3r_abs64(off) < least) {
            least = t3r_abs64(off);
            nearest = (uint8_t)p;
        }
    }
    return nearest;
}

static void assign(filling *f, tally *c)
{
    const t3r_view *view = f->view;
    f->least_q8 = INT64_MAX;
    f->most_q8 = 0;
    for (uint32_t v = 0; v < view->height; v++) {
        for (uint32_t u = 0; u < view->width; u++) {
            const size_t i = (size_t)v * view->width + u;
            f->plane[i] = NO_PLANE;
            if (!is_matched(view, i)) {
                continue;
            }
            const int64_t inverse_q8 = t3r_inverse_depth_q30(view->depth[i]) * 256;
            c->matched++;
            f->plane[i] = plane_of(f, u, v, inverse_q8, c);
            if (f->plane[i] != NO_PLANE) {
                c->on[f->plane[i]]++;
                f->least_q8 = T3R_MIN(f->least_q8, inverse_q8);
                f->most_q8 = T3R_MAX(f->most_q8, inverse_q8);
            }
        }
    }
}

static void judge(filling *f, const tally *c)
{
    uint32_t most = 1;
    for (uint32_t p = 0; p < f->planes.count; p++) {
        most = T3R_MAX(most, c->on[p]);
        f->bounds[p] = BOUND_SHARE * c->on[p] >= c->matched && BOUND_ON * c->behind[p] <= c->on[p];
    }
    f->weight_q2[NO_PLANE] = 4;
    for (uint32_t p = 0; p < f->planes.count; p++) {
        f->weight_q2[p] = (uint32_t)t3r_isqrt64(16 * (uint64_t)most / T3R_MAX(c->on[p], 1));
    }
}

/* Returns the largest one over depth of the bounding planes, 0 without any. */
static int64_t bound_q8(const filling *f, uint32_t u, uint32_t v)
{
    int64_t bound = 0;
    for (uint32_t p = 0; p < f->planes.count; p++) {
        bound = f->bounds[p] ? T3R_MAX(bound, at_q8(f, p, u, v)) : bound;
    }
    return bound;
}

static void begin(const filling *f)
{
    const t3r_view *view = f->view;
    for (uint32_t v = 0; v < view->height; v++) {
        for (uint32_t u = 0; u < view->width; u++) {
            const size_t i = (size_t)v * view->width + u;
            if (f->plane[i] != NO_PLANE &&
                t3r_inverse_depth_q30(view->depth[i]) * 256 < bound_q8(f, u, v) - within_q8(f)) {
                f->plane[i] = NO_PLANE; /* behind a plane that bounds the room */
            }
            if (f->plane[i] == NO_PLANE && view->match_confidence[i] < T3R_STEREO_SURE) {
                view->depth[i] = 0; /* an uncertain match on no plane: filled instead */
                view->match_confidence[i] = T3R_STEREO_NONE;
            }
            f->cost[i] = !is_matched(view, i) ? UINT16_MAX : f->plane[i] == NO_PLANE ? STRAY : 0;
        }
    }
    t3r_stereo_luma(view, f->luma);
}

/* Gives pixel `to` the plane of pixel `from`, if the path through it is shorter. */
static inline void offer(const filling *f, size_t to, size_t from, uint32_t step)
{
    const uint32_t level = (uint32_t)t3r_abs32((int32_t)f->luma[to] - f->luma[from]);
    const uint32_t cost = f->cost[from] + (((step + LEVEL * level) * f->weight_q2[f->plane[from]] + 2) >> 2);
    if (cost < f->cost[to]) {
        f->cost[to] = (uint16_t)cost;
        f->plane[to] = f->plane[from];
        if (f->plane[from] == NO_PLANE && f->view->match_confidence[to] < T3R_STEREO_LEAST) {
            f->view->depth[to] = f->view->depth[from];
        }
    }
}

/* Sweeps one row: from the sweep's last row, then along the row both ways. */
static void sweep_row(const filling *f, size_t row, size_t before, bool first)
{
    const uint32_t width = f->view->width;
    for (uint32_t x = 0; x < width && !first; x++) {
        offer(f, row + x, before + x, STRAIGHT);
        if (x > 0) {
            offer(f, row + x, before + x - 1, DIAGONAL);
        }
        if (x + 1 < width) {
            offer(f, row + x, before + x + 1, DIAGONAL);
        }
    }
    for (uint32_t x = 1; x < width; x++) {
        offer(f, row + x, row + x - 1, STRAIGHT);
    }
    for (uint32_t x = width - 1; x-- > 0;) {
        offer(f, row + x, row + x + 1, STRAIGHT);
    }
}

static void finish(const filling *f)
{
    const t3r_view *view = f->view;
    for (uint32_t v = 0; v < view->height; v++) {
        for (uint32_t u = 0; u < view->width; u++) {
            const size_t i = (size_t)v * view->width + u;
            const bool shown = (view->colour[0][i] | view->colour[1][i] | view->colour[2][i]) != 0;
            if (view->match_confidence[i] >= T3R_STEREO_LEAST || f->cost[i] == UINT16_MAX) {
                continue;
            }
            const int64_t own_q8 =
                f->plane[i] != NO_PLANE ? at_q8(f, f->plane[i], u, v) : t3r_inverse_depth_q30(view->depth[i]) * 256;
            const int64_t inverse_q8 =
                t3r_clamp64(T3R_MAX(own_q8, bound_q8(f, u, v)), (f->least_q8 + 1) / 2, 2 * f->most_q8);
            const int64_t depth = t3r_clamp64(t3r_round_div64(INT64_C(1) << 38, inverse_q8), 1, UINT16_MAX);
            view->depth[i] = (uint16_t)(shown ? depth : 0);
            view->match_confidence[i] = shown ? T3R_STEREO_FILLED : T3R_STEREO_NONE;
        }
    }
}

void t3r_plane_fill(const t3r_view *view, void *work)
{
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    t3r_cut cut = t3r_cut_of(work, T3R_PLANE_FILL_BYTES(view->width, view->height));
    filling f = {.view = view, .middle_x = (int32_t)view->width / 2, .middle_y = (int32_t)view->height / 2};
    tally c = {.matched = 0};
    t3r_search_planes(view, t3r_take(&cut, T3R_PLANE_SEARCH_BYTES), &f.planes);
    f.cost = t3r_take(&cut, pixels * sizeof *f.cost);
    f.plane = t3r_take(&cut, pixels);
    f.luma = t3r_take(&cut, pixels);
    if (f.planes.count == 0) {
        return;
    }
    assign(&f, &c);
    judge(&f, &c);
    begin(&f);
    for (uint32_t sweep = 0; sweep < SWEEPS; sweep++) {
        const bool down = sweep % 2 == 0;
        for (uint32_t i = 0; i < view->height; i++) {
            const size_t row = (size_t)(down ? i : view->height - 1 - i) * view->width;
            sweep_row(&f, row, down ? row - view->width : row + view->width, i == 0);
        }
    }
    finish(&f);
}
