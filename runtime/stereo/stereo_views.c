/* SPDX-License-Identifier: Apache-2.0 */
#include "stereo_views.h"

#include "core/cut.h"
#include "core/fixed.h"
#include "core/memory.h"
#include "state/state.h"
#include "stereo.h"
#include "stereo/planes/plane_fill.h"
#include "stereo_fuse.h"

#define PARTNERS T3R_STEREO_PARTNERS

/* Results of the coarse pass for all pairs, symmetric. */
typedef struct survey {
    uint32_t match_score[T3R_MAX_VIEWS][T3R_MAX_VIEWS];
    uint8_t pair[T3R_MAX_VIEWS][T3R_MAX_VIEWS]; /* t3r_pair */
    uint8_t rank[T3R_MAX_VIEWS][T3R_MAX_VIEWS]; /* number of better partners, for whichever of the two views has
                                                 * fewer */
} survey;

void t3r_stereo_clear(const t3r_view *views, uint32_t count)
{
    for (uint32_t v = 0; v < count; v++) {
        const size_t pixels = T3R_PIXELS_(views[v].width, views[v].height);
        memset(views[v].depth, 0, pixels * sizeof *views[v].depth);
        memset(views[v].validity, T3R_NO_DEPTH, pixels);
    }
}

/* Returns the settings of a pair. Pairs don't fill: filling follows after all of them. */
static t3r_stereo_settings stereo_settings(const t3r_runtime *rt)
{
    return (t3r_stereo_settings){
        .kernels = &rt->kernels,
        .disparities = T3R_STEREO_DISPARITIES,
        .paths = T3R_STEREO_PATHS,
        .fill = 0,
        .workers = t3r_workers_of(rt),
    };
}

/* Runs the coarse pass of all pairs; two views need none. */
static t3r_status look_at_all(const t3r_runtime *rt, const t3r_view *views, survey *found)
{
    const t3r_stereo_settings settings = stereo_settings(rt);
    const uint32_t pairs = rt->views * (rt->views - 1) / 2;
    uint32_t done = 0;
    memset(found, 0, sizeof *found);
    for (uint32_t a = 0; a < rt->views && rt->views > 2; a++) {
        for (uint32_t b = a + 1; b < rt->views; b++) {
            if (!t3r_progress(rt, T3R_STAGE_DEPTH, done++, 2 * pairs)) {
                return T3R_ERR_CANCELLED;
            }
            const t3r_camera cameras[2] = {rt->camera[a], rt->camera[b]};
            const t3r_view both[2] = {views[a], views[b]};
            found->pair[a][b] = (uint8_t)t3r_stereo_match_score(
                &settings, cameras, both, t3r_buffer_at(rt, T3R_BUFFER_STEREO_WORK), &found->match_score[a][b]);
            found->pair[b][a] = found->pair[a][b];
            found->match_score[b][a] = found->match_score[a][b];
        }
    }
    return T3R_OK;
}

/* Whether a is a better partner of v than b: not refused, a higher match score, or earlier. */
static bool precedes(const survey *s, uint32_t v, uint32_t a, uint32_t b)
{
    const bool refused = s->pair[v][a] != T3R_PAIR_OK, other_refused = s->pair[v][b] != T3R_PAIR_OK;
    if (refused != other_refused) {
        return other_refused;
    }
    return s->match_score[v][a] != s->match_score[v][b] ? s->match_score[v][a] > s->match_score[v][b] : a < b;
}

/* Returns the number of other views that are better partners of v than `a`. */
static uint32_t rank(const survey *s, uint32_t count, uint32_t v, uint32_t a)
{
    uint32_t before = 0;
    for (uint32_t w = 0; w < count; w++) {
        before += w != v && w != a && precedes(s, v, w, a);
    }
    return before;
}

static void rank_all(const t3r_runtime *rt, survey *s)
{
    for (uint32_t a = 0; a < rt->views; a++) {
        for (uint32_t b = a + 1; b < rt->views; b++) {
            const uint32_t here = rank(s, rt->views, a, b), there = rank(s, rt->views, b, a);
            s->rank[a][b] = s->rank[b][a] = (uint8_t)T3R_MIN(here, there);
        }
    }
}

/* Places the depths of one pair after its work memory, if several pairs contribute to a view. */
static void divide_pair(const t3r_runtime *rt, t3r_view both[2])
{
    const uint32_t width = rt->config.width, height = rt->config.height;
    const size_t pixels = T3R_PIXELS_(width, height);
    t3r_cut cut =
        t3r_cut_of(t3r_buffer_at(rt, T3R_BUFFER_STEREO_WORK), T3R_STEREO_BYTES_(width, height, rt->config.views, 1));
    (void)t3r_take(&cut, T3R_STEREO_WORK_BYTES(width, height, T3R_STEREO_DISPARITIES, T3R_STEREO_PATHS));
    for (int side = 0; side < 2 && rt->views > 2; side++) {
        both[side].depth = t3r_take(&cut, pixels * sizeof *both[side].depth);
        both[side].match_confidence = t3r_take(&cut, pixels);
    }
}

static void match(t3r_runtime *rt, t3r_view *views, survey *s, uint32_t a, uint32_t b)
{
    const t3r_stereo_settings settings = stereo_settings(rt);
    const t3r_camera cameras[2] = {rt->camera[a], rt->camera[b]};
    const uint32_t index[2] = {a, b};
    t3r_view both[2] = {views[a], views[b]};
    uint64_t unit_q40 = 1;
    divide_pair(rt, both);
    const t3r_pair pair =
        t3r_stereo_depth(&settings, cameras, both, t3r_buffer_at(rt, T3R_BUFFER_STEREO_WORK), &unit_q40);
    s->pair[a][b] = s->pair[b][a] = (uint8_t)pair;
    for (int side = 0; side < 2 && pair == T3R_PAIR_OK; side++) {
        t3r_view *view = &views[index[side]];
        both[side].depth_unit_q40 = unit_q40;
        if (rt->stereo_pair[index[side]] != T3R_PAIR_OK) { /* the first pair sets the view's unit */
            rt->stereo_pair[index[side]] = T3R_PAIR_OK;
            rt->depth_unit_q40[index[side]] = view->depth_unit_q40 = unit_q40;
        }
        if (rt->views > 2) {
            t3r_stereo_fuse(view, &both[side]);
        }
    }
}

/* Matches the pairs of one rank, earlier views first. */
static t3r_status match_rank(t3r_runtime *rt, t3r_view *views, survey *s, uint32_t rank)
{
    const uint32_t pairs = rt->views * (rt->views - 1) / 2;
    uint32_t done = pairs * (PARTNERS + rank) / PARTNERS;
    for (uint32_t a = 0; a < rt->views; a++) {
        for (uint32_t b = a + 1; b < rt->views; b++) {
            if (s->rank[a][b] != rank || s->pair[a][b] != T3R_PAIR_OK) {
                continue;
            }
            if (!t3r_progress(rt, T3R_STAGE_DEPTH, T3R_MIN(done, 2 * pairs - 1), 2 * pairs)) {
                return T3R_ERR_CANCELLED;
            }
            done++;
            match(rt, views, s, a, b);
        }
    }
    return T3R_OK;
}

/* Records which pair each view's depth came from, or why there is none. Returns false when no view has depth. */
static bool settle(t3r_runtime *rt, const survey *s)
{
    bool any = false;
    for (uint32_t v = 0; v < rt->views; v++) {
        uint32_t best = v;
        for (uint32_t w = 0; w < rt->views; w++) { /* includes the view's own first choice */
            if (w != v && s->rank[v][w] < PARTNERS && (best == v || precedes(s, v, w, best))) {
                best = w;
            }
        }
        any = any || rt->stereo_pair[v] == T3R_PAIR_OK;
        rt->stereo_partner[v] = (uint8_t)best;
        if (rt->stereo_pair[v] != T3R_PAIR_OK) {
            rt->stereo_pair[v] = s->pair[v][best];
        }
    }
    return any;
}

typedef struct fill_job {
    const t3r_runtime *rt;
    const t3r_view *views;
    uint32_t first; /* view of task 0 */
    size_t bytes;   /* of each task */
} fill_job;

void t3r_stereo_finish(const t3r_runtime *rt, const t3r_view *views, uint32_t v, uint32_t other, void *work)
{
    const t3r_plane_pair pair = {&rt->kernels, &views[v], &views[other], &rt->camera[v], &rt->camera[other]};
    if (rt->config.fill_radius > 0) {
        t3r_plane_fill(&pair, work);
    }
    t3r_stereo_marks(&views[v], T3R_STEREO_SURE);
}

static void finish_view(void *context, uint32_t index, uint32_t worker)
{
    (void)worker;
    const fill_job *job = context;
    const uint32_t v = job->first + index;
    uint8_t *work = (uint8_t *)t3r_buffer_at(job->rt, T3R_BUFFER_STEREO_WORK) + index * job->bytes;
    t3r_stereo_finish(job->rt, job->views, v, job->rt->stereo_partner[v], work);
}

/* Finishes as many views at once as fit into the work memory of pairs. */
static void finish_views(const t3r_runtime *rt, const t3r_view *views)
{
    const uint32_t width = rt->config.width, height = rt->config.height;
    const t3r_workers workers = t3r_workers_of(rt);
    fill_job job = {.rt = rt, .views = views, .bytes = T3R_PLANE_FILL_BYTES(width, height)};
    const size_t room = T3R_STEREO_WORK_BYTES(width, height, T3R_STEREO_DISPARITIES, T3R_STEREO_PATHS) / job.bytes;
    const uint32_t round = t3r_is_parallel(&workers) ? (uint32_t)T3R_MIN(room, rt->views) : 1;
    for (job.first = 0; job.first < rt->views; job.first += round) {
        t3r_run_tasks(&workers, T3R_MIN(round, rt->views - job.first), finish_view, &job);
    }
}

t3r_status t3r_stereo_views(t3r_runtime *rt, t3r_view *views)
{
    survey s;
    t3r_status status = look_at_all(rt, views, &s);
    rank_all(rt, &s);
    for (uint32_t v = 0; v < rt->views; v++) {
        rt->stereo_pair[v] = T3R_PAIR_OVERLAP; /* until a pair is matched */
    }
    for (uint32_t rank = 0; rank < PARTNERS && status == T3R_OK; rank++) {
        status = match_rank(rt, views, &s, rank);
    }
    if (status == T3R_OK && !settle(rt, &s)) {
        status = T3R_ERR_STEREO;
    }
    if (status == T3R_OK) {
        finish_views(rt, views);
    }
    return status;
}

/* Whether both have the same picture and camera as view v. */
static bool is_same_view(const t3r_runtime *rt, const t3r_runtime *other, uint32_t v, const t3r_view *view)
{
    const t3r_view taken = t3r_view_of(other, v);
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    bool same = memcmp(&rt->camera[v], &other->camera[v], sizeof rt->camera[v]) == 0;
    for (int c = 0; c < 3 && same; c++) {
        same = memcmp(view->colour[c], taken.colour[c], pixels) == 0;
    }
    return same;
}

static bool is_same_stereo(const t3r_runtime *rt, const t3r_runtime *other, const t3r_view *views)
{
    const t3r_config *a = &rt->config, *b = &other->config;
    bool same = t3r_is_by_stereo(b) && a->width == b->width && a->height == b->height && rt->views == other->views &&
                a->fill_radius == b->fill_radius;
    for (uint32_t v = 0; v < rt->views && same; v++) {
        same = is_same_view(rt, other, v, &views[v]);
    }
    return same;
}

bool t3r_stereo_take(t3r_runtime *rt, t3r_view *views)
{
    const t3r_runtime *other = rt->depth_of;
    rt->depth_of = NULL;
    if (other == NULL || !is_same_stereo(rt, other, views)) {
        return false;
    }
    for (uint32_t v = 0; v < rt->views; v++) {
        const t3r_view taken = t3r_view_of(other, v);
        const size_t pixels = T3R_PIXELS_(taken.width, taken.height);
        memcpy(views[v].depth, taken.depth, pixels * sizeof *taken.depth);
        memcpy(views[v].validity, taken.validity, pixels);
        views[v].depth_unit_q40 = rt->depth_unit_q40[v] = other->depth_unit_q40[v];
        rt->stereo_pair[v] = other->stereo_pair[v];
        rt->stereo_partner[v] = other->stereo_partner[v];
    }
    return true;
}
