/* SPDX-License-Identifier: Apache-2.0 */
#include "refine.h"

#include <stdbool.h>

#include "core/camera.h"
#include "core/cut.h"
#include "core/fixed.h"
#include "core/memory.h"
#include "refine_bands.h"
#include "refine_layout.h"
#include "refine_tile.h"
#include "state/remembered.h"
#include "state/state.h"

/* Returns the residual buffer of a band. Band 0 borrows the idle sort histogram. */
static t3r_wanted *wanted_of(const t3r_refine_layout *w, uint32_t band)
{
    return band == 0 ? t3r_raster_spare_histogram(&w->room) : &w->wanted[band - 1];
}

static void shift_each(int32_t *sums, uint32_t count, uint32_t shift)
{
    for (uint32_t i = 0; i < count; i++) {
        sums[i] = t3r_scale32(sums[i], -(int32_t)shift);
    }
}

/* Rescales a Gaussian's sums to the scale of its box in this view, before the view adds to them. */
static void widen(t3r_refine_sums *sums, const t3r_splat *splat)
{
    uint32_t area = sums->area + (uint32_t)(splat->x1 - splat->x0 + 1) * (uint32_t)(splat->y1 - splat->y0 + 1);
    uint32_t shift = t3r_refine_shift(area) - t3r_refine_shift(sums->area);
    sums->area = area;
    if (shift > 0) {
        shift_each(sums->colour, 3, shift);
        shift_each(&sums->weight, 1, shift);
        shift_each(sums->gradient, T3R_REFINE_MOMENTS_2, shift);
        shift_each(sums->curvature, T3R_REFINE_MOMENTS_4, shift);
    }
}

/* One view being drawn, shared by all its bands. */
typedef struct view_job {
    const t3r_runtime *rt;
    const t3r_refine_layout *work;
    const t3r_refine_view *view;
    const t3r_binning *bin;
    uint32_t done, total; /* for the progress hook */
    uint32_t again;       /* splats drawn again since the last call of the hook */
    bool stopped;         /* the hook has cancelled */
    uint32_t begin, end;  /* tiles of the pass; the list of the first one starts at 0 */
    uint32_t next;        /* first tile that is in no chunk yet */
    uint32_t count;       /* bands of this chunk */
    t3r_refine_band bands[T3R_MAX_WORKERS];
} view_job;

/* Tiles and list entries between two calls of the progress hook. One worker calls it more often, as bands cost it
 * nothing: a pair of tile and splat takes about 30,000 instructions of plain C. Where few of a tile's splats are kept,
 * it also calls it within a tile. */
#define TILES_A_CHUNK 256u
#define SPLATS_A_CHUNK 65536u
#define SPLATS_ALONE 256u

/* Bands measured at the same time. Their results are on the stack, which has no room for T3R_MAX_WORKERS bands. */
#define MEASURED_AT_ONCE 4u

/* One view drawn and compared without changing any sums, and the bands' results. */
typedef struct measure_job {
    view_job job;
    uint32_t first; /* first of the bands being measured */
    uint64_t error[MEASURED_AT_ONCE];
    uint32_t pixels[MEASURED_AT_ONCE];
    t3r_level_sums levels[MEASURED_AT_ONCE]; /* filled instead when the view's levels are measured */
} measure_job;

static uint32_t list_begin(const view_job *job, uint32_t tile)
{
    return tile == job->begin ? 0 : job->bin->table[tile - 1];
}

/* Calls the progress hook. Returns false when it has cancelled. */
static bool ask(view_job *job)
{
    job->again = 0;
    job->stopped = job->stopped || !t3r_progress(job->rt, T3R_STAGE_REFINE, job->done, job->total);
    return !job->stopped;
}

static bool draws_again(void *context, uint32_t splats)
{
    view_job *job = context;
    const t3r_workers workers = t3r_workers_of(job->rt);
    if (t3r_is_parallel(&workers)) {
        return true; /* only one worker may call hooks */
    }
    job->again += splats;
    return job->again <= SPLATS_ALONE || ask(job);
}

/* Cuts the next tiles into bands, after filling their lists if no pass has done so. No bands: all tiles are done.
 * Returns false if the progress hook cancels. */
static bool next_chunk(view_job *job)
{
    const t3r_workers workers = t3r_workers_of(job->rt);
    const t3r_binning *bin = job->bin;
    job->count = 0;
    if (job->next == bin->tiles || !ask(job)) {
        return !job->stopped;
    }
    if (job->next == job->end) {
        job->begin = job->end;
        job->end = t3r_bin_pass(&workers, bin, job->begin);
    }
    const uint32_t first = job->next, listed = list_begin(job, first);
    const uint32_t most = T3R_MIN(job->end - first, TILES_A_CHUNK);
    const uint32_t splats = t3r_is_parallel(&workers) ? SPLATS_A_CHUNK : SPLATS_ALONE;
    do {
        job->next++;
    } while (job->next < first + most && bin->table[job->next] - listed <= splats);
    job->count = t3r_refine_bands(bin, first, job->next, listed, &job->view->slice, &job->work->borders, job->bands);
    return true;
}

static void accumulate_band(void *context, uint32_t index, uint32_t worker)
{
    (void)worker; /* each band has its own memory, and there are at most as many bands as workers */
    view_job *job = context;
    const t3r_binning *bin = job->bin;
    const t3r_refine_band *band = &job->bands[index];
    t3r_refine_view view = *job->view;
    view.goes_on = draws_again;
    view.context = job;
    view.bands = job->bands;
    view.band = index;
    view.wanted = wanted_of(job->work, index);
    view.kept = job->work->kept + (size_t)index * job->work->kept_words;
    for (uint32_t tile = band->begin; tile < band->end; tile++) {
        const uint32_t from = list_begin(job, tile);
        t3r_refine_tile(&view, bin->lists + from, t3r_list_length(bin, from, tile), tile % bin->across,
                        tile / bin->across);
    }
}

/* Levels are measured on one tile in four, shifted by two in each row: evenly spread, and enough pixels. */
#define LEVELLED_TILES 4u

static void measure_band(void *context, uint32_t index, uint32_t worker)
{
    (void)worker;
    measure_job *to = context;
    const view_job *job = &to->job;
    const t3r_binning *bin = job->bin;
    const uint32_t band = to->first + index;
    t3r_refine_view view = *job->view;
    view.wanted = wanted_of(job->work, band);
    view.kept = job->work->kept + (size_t)band * job->work->kept_words;
    for (uint32_t tile = job->bands[band].begin; tile < job->bands[band].end; tile++) {
        const uint32_t from = list_begin(job, tile), count = t3r_list_length(bin, from, tile);
        const uint32_t x = tile % bin->across, y = tile / bin->across;
        if (T3R_FEATURE_LOSS && view.structure != NULL) {
            if ((x + 2 * y) % LEVELLED_TILES != 0) {
                continue;
            }
            t3r_refine_tile_levels(&view, bin->lists + from, count, x, y, &to->levels[index]);
        } else {
            to->error[index] += t3r_refine_tile_error(&view, bin->lists + from, count, x, y, &to->pixels[index]);
        }
    }
}

/* Draws view `v` of the scene and compares it. structure: the view's current levels, to measure new ones, or NULL to
 * measure the error. */
static t3r_status measure_view(const t3r_runtime *rt, const t3r_refine_layout *w, const t3r_view *views, uint32_t v,
                               const t3r_structure *structure, uint32_t done, uint32_t total, measure_job *to)
{
    const t3r_workers workers = t3r_workers_of(rt);
    t3r_projection projection;
    t3r_status status =
        t3r_projection_make(&rt->camera[v], &rt->frame, rt->config.width, rt->config.height, &projection);
    if (status != T3R_OK) {
        return status;
    }
    const t3r_binning bin = t3r_raster_list(rt, &projection, &t3r_all_pixels, &w->room);
    const t3r_refine_view view = {
        .kernels = &rt->kernels,
        .view = &views[v],
        .splats = w->room.splats,
        .kept_words = w->kept_words,
        .gain_q14 = rt->gain_q14[v],
        .structure = structure,
    };
    memset(to, 0, sizeof *to);
    to->job = (view_job){.rt = rt, .work = w, .view = &view, .bin = &bin, .done = done, .total = total};
    bool goes_on = next_chunk(&to->job);
    for (; goes_on && to->job.count > 0; goes_on = next_chunk(&to->job)) {
        for (to->first = 0; to->first < to->job.count; to->first += MEASURED_AT_ONCE) {
            t3r_run_tasks(&workers, T3R_MIN(to->job.count - to->first, MEASURED_AT_ONCE), measure_band, to);
        }
    }
    return goes_on ? T3R_OK : T3R_ERR_CANCELLED;
}

/* Gaussians a task begins, solves or applies. */
#define CHUNK 512u

static uint32_t chunks_of(uint32_t count)
{
    return (count + CHUNK - 1) / CHUNK;
}

/* Views between two changes of a build's scene, about. */
#define VIEWS_A_GROUP 4u

typedef struct slice_job {
    const t3r_kernels *kernels;
    const t3r_refine_layout *work;
    t3r_refine_slice slice;
    const t3r_projection *projection; /* of the view being drawn */
    t3r_gaussian *scene;
    const t3r_viewpoints *from;    /* cameras that no Gaussian may move through */
    const t3r_map_record *records; /* NULL: all Gaussians change */
    uint32_t idle_most;
    bool remembers;                 /* a stream that remembers keyframes */
    uint32_t round;                 /* of keyframes shown again; 0 = new ones */
    const t3r_structure *structure; /* one for each view, or NULL */
    bool in_parts;                  /* the pass compares a part of the pixels */
    uint32_t group, groups;         /* the step compares the views v with v mod groups = group */
} slice_job;

static void begin_chunk(void *context, uint32_t index, uint32_t worker)
{
    (void)worker;
    const slice_job *job = context;
    const uint32_t begin = index * CHUNK, count = T3R_MIN(CHUNK, job->slice.count - begin);
    const t3r_splat *splats = &job->work->room.splats[job->slice.first + begin];
    t3r_refine_sums *sums = &job->slice.sums[begin];
    job->kernels->axes(job->projection, &job->scene[job->slice.first + begin], splats, count, sums);
    for (uint32_t i = 0; i < count; i++) {
        if (splats[i].z_q20 != 0) {
            widen(&sums[i], &splats[i]);
        }
    }
}

static void solve_chunk(void *context, uint32_t index, uint32_t worker)
{
    (void)worker;
    const slice_job *job = context;
    t3r_correction *corrections = job->work->corrections + job->slice.first;
    const uint32_t begin = index * CHUNK, count = T3R_MIN(CHUNK, job->slice.count - begin);
    job->kernels->solve(job->slice.sums + begin, count, corrections + begin);
}

/* Damps opacity and place to a share of 1 / (1 + n) after n keyframes saw the Gaussian, so that the next one doesn't
 * undo what they agreed on, and a Gaussian that is seen again and again doesn't drift off its surface. Damps shape half
 * as much, and from the fourth keyframe on to three times that share: undamped, widths would shrink for ever. Where
 * keyframes are remembered, damps all alike; else colour follows the newest ones. In round n of keyframes that are
 * shown again, damps all alike to 1 / (1 + n), however many saw the Gaussian. */
static t3r_correction settled(const t3r_correction *whole, uint32_t fitted, bool remembers, uint32_t round)
{
    const bool alike = remembers || round > 0;
    const uint32_t seen = round > 0 ? round : T3R_MIN(fitted, T3R_FITTED_MOST);
    const int32_t share_q15 = (1 << 15) / (1 + (int32_t)seen);
    const int32_t shape_q15 = alike ? share_q15 : T3R_MIN((share_q15 + (1 << 15)) / 2, 3 * share_q15);
    t3r_correction c = *whole;
    for (int i = 0; i < 3 && alike; i++) {
        c.colour_q7[i] = (int16_t)t3r_round_shift32(c.colour_q7[i] * share_q15, 15);
    }
    for (int i = 0; i < 6; i++) {
        c.step_q16[i] = (int16_t)t3r_round_shift32(c.step_q16[i] * (i < 3 ? share_q15 : shape_q15), 15);
    }
    return c;
}

/* Applies the corrections; here the slice is the whole scene. */
static void apply_chunk(void *context, uint32_t index, uint32_t worker)
{
    (void)worker;
    const slice_job *job = context;
    const uint32_t end = T3R_MIN((index + 1) * CHUNK, job->slice.count);
    for (uint32_t i = index * CHUNK; i < end; i++) {
        const t3r_correction *correction = &job->work->corrections[i];
        if (T3R_FEATURE_BACKDROP && job->scene[i].view == T3R_NO_VIEW) {
            t3r_refine_apply_colour(correction, &job->scene[i]);
        } else if (!T3R_FEATURE_STREAMS || job->records == NULL) {
            t3r_refine_apply(correction, job->from, &job->scene[i]);
        } else if (job->records[i].idle < job->idle_most) {
            const t3r_correction part = settled(correction, job->records[i].fitted, job->remembers, job->round);
            t3r_refine_apply(&part, job->from, &job->scene[i]);
        }
    }
}

/* A view that a pass draws: a live one or a remembered keyframe. */
typedef struct shown_view {
    const t3r_view *view; /* for a remembered keyframe only its size is read */
    const t3r_camera *camera;
    const uint16_t *gain_q14;
    const uint16_t *remembered;     /* pixels; NULL: the view has planes */
    const t3r_structure *structure; /* NULL: residuals count unchanged */
    t3r_lattice lattice;            /* pixels that are compared */
} shown_view;

/* Returns the pixels that a pass compares: in parts each of the four lattices in turn. */
static t3r_lattice lattice_of(const slice_job *slice, uint32_t turn)
{
    static const t3r_lattice quarters[] = {{1, 0, 0}, {1, 1, 1}, {1, 1, 0}, {1, 0, 1}};
    return T3R_FEATURE_PARTS && slice->in_parts ? quarters[turn % 4] : t3r_all_pixels;
}

/* Draws the view and adds to the sums of the slice. */
static t3r_status accumulate(const t3r_runtime *rt, slice_job *slice, const shown_view *shown, uint32_t done,
                             uint32_t total)
{
    t3r_projection projection;
    t3r_status status =
        t3r_projection_make(shown->camera, &rt->frame, rt->config.width, rt->config.height, &projection);
    if (status != T3R_OK) {
        return status;
    }
    const t3r_workers workers = t3r_workers_of(rt);
    const t3r_refine_layout *w = slice->work;
    const t3r_binning bin = t3r_raster_list(rt, &projection, &shown->lattice, &w->room);
    slice->projection = &projection;
    t3r_run_tasks(&workers, chunks_of(slice->slice.count), begin_chunk, slice);
    const t3r_refine_view view = {
        .kernels = &rt->kernels,
        .view = shown->view,
        .splats = w->room.splats,
        .slice = slice->slice,
        .borders = &w->borders,
        .across = bin.across,
        .lattice = shown->lattice,
        .kept_words = w->kept_words,
        .gain_q14 = shown->gain_q14,
        .remembered = shown->remembered,
        .structure = shown->structure,
    };
    view_job job = {.rt = rt, .work = w, .view = &view, .bin = &bin, .done = done, .total = total};
    bool goes_on = next_chunk(&job);
    for (; goes_on && job.count > 0; goes_on = next_chunk(&job)) {
        t3r_run_tasks(&workers, job.count, accumulate_band, &job);
        t3r_refine_join(job.bands, job.count, &w->borders, &view.slice);
    }
    return goes_on ? T3R_OK : T3R_ERR_CANCELLED;
}

/* Draws the remembered keyframes whose turn it is, except those out of the map's range. */
static t3r_status accumulate_remembered(const t3r_runtime *rt, slice_job *slice, const t3r_view *size, uint32_t turn,
                                        uint32_t *done, uint32_t total)
{
    const uint32_t most = t3r_remembered_a_pass(rt);
    for (uint32_t i = 0; i < most; i++, ++*done) {
        t3r_remembered *keyframe = t3r_remembered_at(rt, (turn * T3R_REMEMBERED_A_PASS + i) % rt->remembered);
        const shown_view shown = {size, &keyframe->camera,          keyframe->gain_q14, t3r_remembered_pixels(keyframe),
                                  NULL, lattice_of(slice, turn + i)};
        t3r_pose pose;
        if (!t3r_progress(rt, T3R_STAGE_REFINE, *done, total)) {
            return T3R_ERR_CANCELLED;
        }
        if (t3r_camera_check(shown.camera, size->width, size->height) != T3R_OK ||
            t3r_pose_in_scene(shown.camera, &rt->frame, &pose) != T3R_OK) {
            continue;
        }
        t3r_status status = accumulate(rt, slice, &shown, *done, total);
        if (status != T3R_OK) {
            return status;
        }
    }
    return T3R_OK;
}

/* Computes the sums of a slice over the views of a step. */
static t3r_status accumulate_views(const t3r_runtime *rt, slice_job *slice, const t3r_view *views, uint32_t turn,
                                   uint32_t *done, uint32_t total)
{
    memset(slice->slice.sums, 0, (size_t)slice->slice.count * sizeof *slice->slice.sums);
    for (uint32_t v = slice->group; v < rt->views; v += slice->groups, ++*done) {
        if (!t3r_progress(rt, T3R_STAGE_REFINE, *done, total)) {
            return T3R_ERR_CANCELLED;
        }
        const shown_view shown = {&views[v],
                                  &rt->camera[v],
                                  rt->gain_q14[v],
                                  NULL,
                                  T3R_FEATURE_LOSS && slice->structure != NULL ? &slice->structure[v] : NULL,
                                  lattice_of(slice, turn + v)};
        t3r_status status = accumulate(rt, slice, &shown, *done, total);
        if (status != T3R_OK) {
            return status;
        }
    }
    return t3r_is_stream(&rt->config) ? accumulate_remembered(rt, slice, views, turn, done, total) : T3R_OK;
}

/* Measures the levels of all views on the current scene. */
static t3r_status measure_levels(const t3r_runtime *rt, const t3r_refine_layout *w, const t3r_view *views,
                                 uint32_t done, uint32_t total, t3r_structure structure[T3R_MAX_VIEWS])
{
    t3r_view_levels lines[T3R_MAX_VIEWS];
    for (uint32_t v = 0; v < rt->views; v++) {
        measure_job found;
        t3r_status status = measure_view(rt, w, views, v, &structure[v], done, total, &found);
        if (status != T3R_OK) {
            return status;
        }
        for (uint32_t i = 1; i < MEASURED_AT_ONCE; i++) {
            t3r_join_levels(&found.levels[0], &found.levels[i]);
        }
        lines[v] = t3r_fit_levels(&found.levels[0]);
    }
    t3r_center_levels(lines, rt->views);
    for (uint32_t v = 0; v < rt->views; v++) {
        t3r_move_levels(&structure[v].levels, &lines[v]);
    }
    return T3R_OK;
}

/* Sets up the structural loss of a pass. The first pass corrects colours, so contrast counts only from the second
 * on. */
static t3r_status find_structure(const t3r_runtime *rt, const t3r_refine_layout *w, const t3r_view *views,
                                 uint32_t pass, uint32_t done, uint32_t total, t3r_structure structure[T3R_MAX_VIEWS])
{
    for (uint32_t v = 0; v < rt->views; v++) {
        structure[v].contrast = pass > 0;
    }
    return rt->views > 1 && pass < T3R_LEVELLED_PASSES ? measure_levels(rt, w, views, done, total, structure) : T3R_OK;
}

static t3r_status find_viewpoints(const t3r_runtime *rt, t3r_viewpoints *from)
{
    from->count = rt->views;
    for (uint32_t v = 0; v < rt->views; v++) {
        t3r_pose pose;
        t3r_status status = t3r_pose_in_scene(&rt->camera[v], &rt->frame, &pose);
        if (status != T3R_OK) {
            return status;
        }
        memcpy(from->position_q20[v], pose.position_q20, sizeof pose.position_q20);
    }
    return T3R_OK;
}

/* Returns the groups that the views of a build form in a pass. Changed after each group, a scene of many views comes as
 * far in a pass as one of few. All views together have the last word. */
static uint32_t groups_of(const t3r_runtime *rt, bool is_last)
{
    const bool in_groups = !t3r_is_stream(&rt->config) && !is_last;
    return in_groups ? T3R_MAX((rt->views + VIEWS_A_GROUP / 2) / VIEWS_A_GROUP, 1) : 1;
}

/* Fits all Gaussians to the views of a step, slice by slice, and changes them. */
static t3r_status refine_step(const t3r_runtime *rt, slice_job *job, const t3r_view *views, uint32_t turn,
                              uint32_t *done, uint32_t total)
{
    const t3r_workers workers = t3r_workers_of(rt);
    for (uint32_t first = 0; first < rt->gaussians; first += job->work->slice) {
        job->slice.first = first;
        job->slice.count = T3R_MIN(job->work->slice, rt->gaussians - first);
        t3r_status status = accumulate_views(rt, job, views, turn, done, total);
        if (status != T3R_OK) {
            return status;
        }
        t3r_run_tasks(&workers, chunks_of(job->slice.count), solve_chunk, job);
    }
    job->slice.first = 0;
    job->slice.count = rt->gaussians;
    t3r_run_tasks(&workers, chunks_of(rt->gaussians), apply_chunk, job);
    return T3R_OK;
}

t3r_status t3r_refine_scene(t3r_runtime *rt, const t3r_view *views, t3r_passes passes, uint32_t round,
                            const t3r_map_record *records)
{
    const t3r_refine_layout w = t3r_refine_layout_of(rt);
    t3r_viewpoints from;
    t3r_status found = find_viewpoints(rt, &from);
    if (found != T3R_OK) {
        return found;
    }
    slice_job job = {.kernels = &rt->kernels,
                     .work = &w,
                     .slice = {w.sums, 0, 0},
                     .scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE),
                     .from = &from,
                     .records = records,
                     .idle_most = rt->config.views,
                     .remembers = rt->config.remember > 0,
                     .round = round};
    const uint32_t slices = (rt->gaussians + w.slice - 1) / w.slice;
    uint32_t total = passes.count * slices * (rt->views + t3r_remembered_a_pass(rt)), done = 0;
    t3r_structure structure[T3R_MAX_VIEWS] = {0};
    job.structure = T3R_FEATURE_LOSS && rt->config.structural && records == NULL ? structure : NULL;
    memset(w.corrections, 0, (size_t)rt->gaussians * sizeof *w.corrections);
    for (uint32_t pass = 0; pass < passes.count; pass++) {
        job.in_parts = pass < passes.parts;
        if (T3R_FEATURE_LOSS && job.structure != NULL) {
            t3r_status status = find_structure(rt, &w, views, pass, done, total, structure);
            if (status != T3R_OK) {
                return status;
            }
        }
        job.groups = groups_of(rt, pass + 1 == passes.count);
        for (job.group = 0; job.group < job.groups; job.group++) {
            t3r_status status = refine_step(rt, &job, views, rt->keyframes * passes.count + pass, &done, total);
            if (status != T3R_OK) {
                return status;
            }
        }
    }
    return T3R_OK;
}

t3r_status t3r_refine(t3r_runtime *rt, const t3r_view *views, t3r_passes passes)
{
    return t3r_refine_scene(rt, views, passes, 0, NULL);
}

t3r_status t3r_refine_error(t3r_runtime *rt, const t3r_view *views, uint32_t *error_q8)
{
    const t3r_refine_layout w = t3r_refine_layout_of(rt);
    uint64_t error = 0; /* below 3 x 2^24 x 2^28 */
    uint32_t pixels = 0;
    for (uint32_t v = 0; v < rt->views; v++) {
        if (!t3r_progress(rt, T3R_STAGE_REFINE, v, rt->views)) {
            return T3R_ERR_CANCELLED;
        }
        measure_job found;
        t3r_status status = measure_view(rt, &w, views, v, NULL, v, rt->views, &found);
        if (status != T3R_OK) {
            return status;
        }
        for (uint32_t i = 0; i < MEASURED_AT_ONCE; i++) {
            error += found.error[i];
            pixels += found.pixels[i];
        }
    }
    *error_q8 = pixels == 0 ? 0 : (uint32_t)t3r_round_div64((int64_t)error, 3 * (int64_t)pixels);
    return T3R_OK;
}
