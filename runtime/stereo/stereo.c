/* SPDX-License-Identifier: Apache-2.0 */
/* Stereo of one pair of views, from colours to depth. */
#include "stereo.h"

#include "core/fixed.h"
#include "core/memory.h"
#include "match_clean.h"
#include "stereo_depth.h"
#include "stereo_planes.h"

/* The coarse pass runs at a quarter of the size. */
#define QUARTER 4
/* Rows of that size drawn at once, where there is room. */
#define BAND 8
/* The outermost 1/128 of coarse disparities on either side count as errors. */
#define TAIL 128
/* Disparities added on either side of the range from the coarse pass, pixels. */
#define MARGIN 6
/* Disparities may be below 0 by this where poses are inexact, pixels. */
#define BEYOND_INFINITY 2
/* Disparity at which a pixel counts half in the match score, pixels. */
#define HALF_KNOWN 8
/* A pair is refused when the coarse pass trusts less than 1/16 of the pixels. */
#define LEAST_SHARE 16

/* A pair of planes with its work memory; the right plane is `disparities` - 1 columns wider. */
typedef struct planes {
    t3r_stereo_side side[2];
    size_t pixels[2]; /* capacity */
    uint8_t *work;
    size_t work_bytes;
} planes;

static planes divide(const t3r_stereo_settings *settings, uint32_t width, uint32_t height, void *work)
{
    planes p = {.pixels = {T3R_STEREO_LEFT_(width, height), T3R_STEREO_RIGHT_(width, height, settings->disparities)}};
    t3r_cut cut = t3r_cut_of(work, T3R_STEREO_WORK_BYTES(width, height, settings->disparities, settings->paths));
    for (int side = 0; side < 2; side++) {
        p.side[side] = t3r_take_side(&cut, p.pixels[side]);
    }
    p.work_bytes = T3R_STEREO_REST_BYTES_(width, height, settings->disparities, settings->paths);
    p.work = t3r_take(&cut, p.work_bytes);
    return p;
}

/* Lays out planes of a quarter of the size in the memory of the full size's confidences and disparities. */
static planes divide_quarter(const planes *full, uint32_t width, uint32_t height, uint32_t disparities)
{
    planes p = {.pixels = {(size_t)width * height, T3R_MATCH_RIGHT(width, disparities) * height}, .work = full->work};
    for (int side = 0; side < 2; side++) {
        const size_t room = T3R_STEREO_SIDE_BYTES_(full->pixels[side]) - T3R_UP_(full->pixels[side]);
        t3r_cut cut = t3r_cut_of(full->side[side].confidence, room);
        p.side[side] = t3r_take_side(&cut, p.pixels[side]);
    }
    return p;
}

static t3r_match match_of(const planes *p, const t3r_stereo_settings *settings, uint32_t width, uint32_t height,
                          uint32_t disparities)
{
    return (t3r_match){
        .kernels = settings->kernels,
        .width = width,
        .height = height,
        .disparities = disparities,
        .paths = settings->paths,
        .p1 = T3R_STEREO_P1,
        .p2 = T3R_STEREO_P2,
        .p2_min = T3R_STEREO_P2_MIN,
        .luma = {p->side[0].luma, p->side[1].luma},
        .disparity = {p->side[0].disparity, p->side[1].disparity},
        .confidence = {p->side[0].confidence, p->side[1].confidence},
        .work = p->work,
    };
}

/* Computes luma: 1..255, 0 where the view shows nothing, which undistortion makes black. */
static void luma_of(const t3r_view *view, uint8_t *restrict luma)
{
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    const uint8_t *r = view->colour[0], *g = view->colour[1], *b = view->colour[2];
    for (size_t i = 0; i < pixels; i++) {
        const uint8_t value = (uint8_t)((77 * r[i] + 150 * g[i] + 29 * b[i] + 128) >> 8), any = r[i] | g[i] | b[i];
        luma[i] = value == 0 && any != 0 ? 1 : value;
    }
}

/* One side of a rectified pair, drawn row by row. */
typedef struct side_job {
    const t3r_kernels *kernels;
    const t3r_rectification *rect;
    uint32_t side, columns;
    int32_t begin_q16;
    const uint8_t *luma; /* of the view */
    uint8_t *out;
} side_job;

static void rectify_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const side_job *job = context;
    t3r_rectified_rows(job->kernels, job->rect, job->side, job->luma, job->begin_q16, (t3r_share){begin, end},
                       job->columns, job->out + (size_t)begin * job->columns);
}

/* Returns where a plane's columns begin. The right plane begins where `first` is the disparity of k = 0. */
static int32_t begin_q16(const t3r_rectification *rect, uint32_t side, int32_t first, uint32_t disparities)
{
    return rect->first_q16[0] - (side == 0 ? 0 : (first + (int32_t)disparities - 1) * 65536);
}

/* Computes one row at a quarter of the size: means of 4 x 4 pixels, 0 unless all of them show something. rows: four
 * rows, `pitch` apart. */
static __attribute__((noinline)) void quarter_row(const uint8_t *rows, size_t pitch, uint32_t count,
                                                  uint8_t *restrict out)
{
    for (uint32_t x = 0; x < count; x++) {
        uint32_t sum = 0, least = UINT8_MAX;
        for (uint32_t i = 0; i < QUARTER * QUARTER; i++) {
            uint8_t value = rows[i / QUARTER * pitch + QUARTER * x + i % QUARTER];
            sum += value;
            least = T3R_MIN(least, value);
        }
        out[x] = (uint8_t)(least == 0 ? 0 : (sum + 8) >> 4);
    }
}

static uint32_t lanes(uint32_t disparities)
{
    return (disparities + T3R_PATH_LANES - 1) / T3R_PATH_LANES * T3R_PATH_LANES;
}

/* The right plane in full size as the coarse pass drew it. columns, rows: 0 if there was no room to keep it. */
typedef struct drawing {
    const uint8_t *view; /* luma of the right view */
    const uint8_t *luma;
    uint32_t columns, rows;
    int32_t begin_q16;
} drawing;

/* Draws the right plane at a quarter of the size. Each worker has `band` times four rows of the full size. */
typedef struct quarter_job {
    side_job full; /* with a quarter of the columns */
    uint32_t band;
    bool kept; /* all rows of the full size are kept */
    uint8_t *rows;
} quarter_job;

static void quarter_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    const quarter_job *job = context;
    const side_job *full = &job->full;
    const uint32_t columns = QUARTER * full->columns;
    for (uint32_t first = begin; first < end; first += job->band) {
        const uint32_t last = T3R_MIN(first + job->band, end);
        uint8_t *rows = job->rows + (size_t)(job->kept ? first : worker * job->band) * QUARTER * columns;
        t3r_rectified_rows(full->kernels, full->rect, full->side, full->luma, full->begin_q16,
                           (t3r_share){QUARTER * first, QUARTER * last}, columns, rows);
        for (uint32_t y = first; y < last; y++) {
            quarter_row(rows + (size_t)(y - first) * QUARTER * columns, columns, full->columns,
                        full->out + (size_t)y * full->columns);
        }
    }
}

/* Result of the coarse pass: disparities from `first` on, at most as many as the settings allow; the match score; and
 * what was drawn of the right plane. */
typedef struct look {
    int32_t first;
    uint32_t disparities;
    uint32_t match_score; /* t3r_stereo_match_score() */
    drawing right;
} look;

/* Returns the match score: each trusted pixel counts d / (d + HALF_KNOWN) at a disparity of d pixels, in 256ths. */
static uint32_t match_score_of(const uint32_t *histogram, uint32_t count, int32_t base)
{
    uint32_t sum = 0; /* below 2^20 x 2^8 */
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t d = (uint32_t)T3R_MAX(base + (int32_t)(QUARTER * k), 0);
        sum += histogram[k] * (256 * d / (d + HALF_KNOWN));
    }
    return sum;
}

/* Draws the left plane's luma in full size, which doesn't depend on the disparities found, and at a quarter of the
 * size. This function and the next are not inlined, because workers' tasks need the stack of their caller's
 * histogram. */
static __attribute__((noinline)) void fill_left(const t3r_stereo_settings *settings, const t3r_rectification *rect,
                                                const t3r_view *view, const planes *full, uint8_t *out)
{
    const uint32_t width = rect->width / QUARTER, height = rect->height / QUARTER;
    side_job job = {.kernels = settings->kernels,
                    .rect = rect,
                    .side = 0,
                    .columns = rect->width,
                    .begin_q16 = rect->first_q16[0],
                    .luma = full->work,
                    .out = full->side[0].luma};
    luma_of(view, full->work);
    t3r_run_rows(&settings->workers, rect->height, rectify_rows, &job);
    for (uint32_t y = 0; y < height; y++) {
        quarter_row(job.out + (size_t)y * QUARTER * rect->width, rect->width, width, out + (size_t)y * width);
    }
}

/* Whether the coarse pass's matching leaves `bytes` of the work memory. */
static bool look_leaves(const t3r_stereo_settings *settings, const planes *full, const t3r_match *coarse, size_t bytes)
{
    const size_t taken = T3R_MATCH_WORK_BYTES(coarse->width, coarse->height, coarse->disparities, settings->paths);
    return taken + bytes <= full->work_bytes;
}

/* Draws the right plane at a quarter of the size. In full size it is kept with the view's luma at the end of the work
 * memory, if there is room. */
static __attribute__((noinline)) void fill_right(const t3r_stereo_settings *settings, const t3r_rectification *rect,
                                                 const t3r_view *view, const planes *full, const t3r_match *coarse,
                                                 uint8_t *out, drawing *drawn)
{
    const uint32_t count = coarse->disparities, columns = (uint32_t)T3R_MATCH_RIGHT(coarse->width, count);
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    const size_t four_rows = QUARTER * QUARTER * (size_t)columns;
    quarter_job job = {.full = {.kernels = settings->kernels,
                                .rect = rect,
                                .side = 1,
                                .columns = columns,
                                .begin_q16 = begin_q16(rect, 1, rect->least_disparity, QUARTER * (count - 1) + 1),
                                .out = out},
                       .band = BAND};
    t3r_workers workers = settings->workers;
    const size_t bytes = pixels + four_rows * coarse->height;
    uint8_t *luma = full->work;
    if (look_leaves(settings, full, coarse, bytes)) {
        luma += full->work_bytes - bytes;
        job.kept = true;
        job.rows = luma + pixels;
        drawn->view = luma;
        drawn->luma = job.rows;
        drawn->columns = QUARTER * columns;
        drawn->rows = QUARTER * coarse->height;
        drawn->begin_q16 = job.full.begin_q16;
    } else {
        const size_t room = full->pixels[1] / four_rows;
        workers.count = workers.count <= room ? workers.count : 1;
        job.band = (uint32_t)T3R_MIN(T3R_MAX(room / T3R_MAX(workers.count, 1), 1), BAND);
        job.rows = full->side[1].luma;
    }
    job.full.luma = luma;
    luma_of(view, luma);
    t3r_run_rows(&workers, coarse->height, quarter_rows, &job);
}

/* Draws the right plane for the disparities found, reusing what the coarse pass drew. */
typedef struct right_job {
    side_job side;
    drawing drawn;
} right_job;

static void finish_right(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const right_job *job = context;
    const side_job *side = &job->side;
    /* columns x in from..to - 1 are already drawn at x + apart */
    const int32_t apart = (side->begin_q16 - job->drawn.begin_q16) / 65536, columns = (int32_t)side->columns;
    const int32_t from = t3r_clamp32(-apart, 0, columns);
    const int32_t to = t3r_clamp32((int32_t)job->drawn.columns - apart, from, columns);
    for (uint32_t y = begin; y < end; y++) {
        const bool drawn = y < job->drawn.rows;
        const int32_t gaps[2][2] = {{0, drawn ? from : columns}, {drawn ? to : columns, columns}};
        uint8_t *out = side->out + (size_t)y * side->columns;
        for (int i = 0; i < 2; i++) {
            t3r_rectified_rows(side->kernels, side->rect, side->side, side->luma, side->begin_q16 + gaps[i][0] * 65536,
                               (t3r_share){y, y + 1}, (uint32_t)(gaps[i][1] - gaps[i][0]), out + gaps[i][0]);
        }
        if (drawn) {
            memcpy(out + from, job->drawn.luma + (size_t)y * job->drawn.columns + from + apart, (size_t)(to - from));
        }
    }
}

/* Computes the range of disparities that the coarse pass trusts, and the match score. */
static __attribute__((noinline)) t3r_pair judge(const t3r_stereo_settings *settings, const planes *p, uint32_t pixels,
                                                uint32_t count, int32_t base, look *found)
{
    uint32_t histogram[T3R_PATH_MOST] = {0}, trusted = 0, shown = 0;
    for (size_t i = 0; i < pixels; i++) {
        shown += p->side[0].luma[i] != 0;
        if (p->side[0].confidence[i] != 0) {
            histogram[T3R_MIN(p->side[0].disparity[i] >> T3R_DISPARITY_BITS, (int)count - 1)]++;
            trusted++;
        }
    }
    found->match_score = match_score_of(histogram, count, base);
    if (trusted < 64 || trusted < shown / LEAST_SHARE) {
        return T3R_PAIR_OVERLAP;
    }
    uint32_t low = 0, high = count - 1, below = histogram[low], above = histogram[high];
    while (below <= trusted / TAIL) {
        below += histogram[++low]; /* ends: all pixels together are more than the tail */
    }
    while (above <= trusted / TAIL) {
        above += histogram[--high];
    }
    const uint32_t most = (settings->disparities - 2 * MARGIN) / QUARTER; /* coarse disparities that fit */
    if (high - low + 1 > most) {
        /* the window with the most pixels, the first of equals */
        uint32_t inside = 0, best = 0, best_low = low;
        for (uint32_t k = low; k <= high; k++) {
            inside += histogram[k];
            inside -= k >= low + most ? histogram[k - most] : 0;
            if (inside > best) {
                best = inside;
                best_low = k + 1 >= low + most ? k + 1 - most : low;
            }
        }
        low = best_low;
        high = low + most - 1;
    }
    found->first = T3R_MAX(base + (int32_t)(QUARTER * low) - MARGIN, -BEYOND_INFINITY);
    const int32_t last = base + (int32_t)(QUARTER * (high + 1)) + MARGIN - 1;
    found->disparities = T3R_MIN(lanes((uint32_t)(last - found->first + 1)), settings->disparities);
    return T3R_PAIR_OK;
}

static t3r_pair first_look(const t3r_stereo_settings *settings, const t3r_rectification *rect, const t3r_view views[2],
                           const planes *full, look *found)
{
    const uint32_t width = rect->width / QUARTER, height = rect->height / QUARTER;
    const int32_t base = rect->least_disparity;
    const uint32_t wanted = (uint32_t)(rect->most_disparity - base) / QUARTER + 1;
    /* limited by the number of columns and the work memory */
    const uint32_t room = T3R_MIN(T3R_MIN(rect->width, T3R_PATH_MOST), QUARTER * settings->disparities);
    const uint32_t count = lanes(T3R_MIN(wanted, room));
    const planes p = divide_quarter(full, width, height, count);
    fill_left(settings, rect, &views[0], full, p.side[0].luma);
    const t3r_match match = match_of(&p, settings, width, height, count);
    fill_right(settings, rect, &views[1], full, &match, p.side[1].luma, &found->right);
    t3r_match_pair(&match);
    t3r_match_agree(&match);
    (void)t3r_match_speckles(&match, 0);
    return judge(settings, &p, width * height, count, base, found);
}

t3r_pair t3r_stereo_match_score(const t3r_stereo_settings *settings, const t3r_camera cameras[2],
                                const t3r_view views[2], void *work, uint32_t *score)
{
    const uint32_t width = views[0].width, height = views[0].height;
    const planes full = divide(settings, width, height, work);
    t3r_rectification rect;
    look found = {.match_score = 0};
    t3r_pair pair = t3r_rectify(&cameras[0], &cameras[1], width, height, settings->disparities, &rect);
    if (pair == T3R_PAIR_OK) {
        pair = first_look(settings, &rect, views, &full, &found);
    }
    *score = found.match_score;
    return pair;
}

t3r_pair t3r_stereo_depth(const t3r_stereo_settings *settings, const t3r_camera cameras[2], const t3r_view views[2],
                          void *work, uint64_t *depth_unit_q40)
{
    const uint32_t width = views[0].width, height = views[0].height;
    const planes full = divide(settings, width, height, work);
    t3r_rectification rect;
    look seen = {.match_score = 0};
    t3r_pair pair = t3r_rectify(&cameras[0], &cameras[1], width, height, settings->disparities, &rect);
    if (pair == T3R_PAIR_OK) {
        pair = first_look(settings, &rect, views, &full, &seen);
    }
    if (pair != T3R_PAIR_OK) {
        return pair;
    }
    t3r_stereo_planes found = {
        .rect = &rect, .filled = settings->fill != 0, .first = seen.first, .disparities = seen.disparities};
    const t3r_match match = match_of(&full, settings, rect.width, rect.height, found.disparities);
    for (uint32_t side = 0; side < 2; side++) {
        const uint32_t columns = side == 0 ? rect.width : (uint32_t)T3R_MATCH_RIGHT(rect.width, found.disparities);
        found.begin_q16[side] = begin_q16(&rect, side, found.first, found.disparities);
        found.columns[side] = columns;
        found.disparity[side] = full.side[side].disparity;
        found.confidence[side] = full.side[side].confidence;
    }
    if (seen.right.view == NULL) {
        luma_of(&views[1], full.work); /* the coarse pass has drawn the left plane's luma */
    }
    right_job job = {.side = {.kernels = settings->kernels,
                              .rect = &rect,
                              .side = 1,
                              .columns = found.columns[1],
                              .begin_q16 = found.begin_q16[1],
                              .luma = seen.right.view != NULL ? seen.right.view : full.work,
                              .out = full.side[1].luma},
                     .drawn = seen.right};
    t3r_run_rows(&settings->workers, rect.height, finish_right, &job);
    t3r_match_all(&match, settings->fill != 0);
    pair = t3r_stereo_unit(settings->kernels, &found, views, depth_unit_q40);
    for (uint32_t side = 0; side < 2 && pair == T3R_PAIR_OK; side++) {
        t3r_stereo_to_view(settings->kernels, &found, side, &views[side], &settings->workers);
    }
    return pair;
}

void t3r_stereo_marks(const t3r_view *view, uint32_t least)
{
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    const uint16_t *depth = view->depth;
    const uint8_t *confidence = view->match_confidence, doubtful = t3r_marked(T3R_MEASURED, T3R_MARK_DOUBTFUL);
    uint8_t *restrict validity = view->validity;
    for (size_t i = 0; i < pixels; i++) {
        const uint8_t c = confidence[i], matched = c >= least ? T3R_MEASURED : doubtful;
        const uint8_t any = c >= T3R_STEREO_LEAST ? matched : T3R_FILLED;
        validity[i] = depth[i] == 0 ? T3R_NO_DEPTH : any;
    }
}
