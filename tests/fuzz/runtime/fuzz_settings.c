/* SPDX-License-Identifier: Apache-2.0 */
/* Turns bytes into a case (drawn_case.h) and a way of running it that varies everything without influence on results:
 * the arena's size, place, previous contents and use, settings that reserve more memory, the number of workers and the
 * order of their tasks, the processor's variants, strips instead of whole frames, bytes between rows, and a call that
 * was cancelled and repeated. The plain way is a firmware's: plain C, one worker, all in order. Both give the same
 * statuses, hashes of stages, scenes and pictures; a difference is printed and ends the program. */
#include <stddef.h>
#include <string.h>

#include "core/fixed.h"
#include "drawn_case.h"
#include "host/cpu.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

/* ---- ways ---------------------------------------------------------------------------------------- */

enum { MOST_CALLS = 32, MOST_WORKERS_DRAWN = 8, FULL_Q8 = 255 };

/* In the plain way all are 0 except `workers` and `arena_q8`. A part drawn as 0 is also plain. */
typedef struct way {
    uint8_t arena_q8;   /* 0 = the minimum; FULL_Q8 = for full speed */
    uint8_t beyond;     /* bytes above that */
    uint8_t fill;       /* previous contents of the memory */
    uint8_t moves;      /* one bit per call, modulo 8: the arena moves before it */
    uint8_t workers;    /* 1..MOST_WORKERS_DRAWN */
    uint8_t order;      /* seed of the tasks' order */
    uint8_t cpu;        /* chooses among the processor's features, another choice for each call */
    uint8_t strips;     /* one bit per view: added in strips */
    uint8_t heights[2]; /* heights of strips, less 1, of colour and depth */
    uint8_t abandons;   /* one bit per view: a strip of it is added and abandoned first */
    uint8_t padding;    /* bytes, or elements, between rows */
    uint8_t room;       /* bits of ROOM_ */
    uint8_t cancels;    /* number of the call, from 1 on; 0 = none */
    uint8_t cancels_q8; /* share of the call that runs before it is cancelled */
    uint8_t before;     /* calls of the same case before it that a reset ends */
} way;

static const way plain = {.arena_q8 = FULL_Q8, .workers = 1};

enum {
    ROOM_GAUSSIANS = 1,
    ROOM_TARGET = 2,
    ROOM_ANALYSIS = 4,
    ROOM_COLUMN = 8,
    ROOM_TILE = 16,
    ROOM_WARM = 32,
    ROOM_VIEWS = 64,
    ROOM_REQUEST = 128, /* requests fields that a request leaves open */
};

static way take_way(input *in)
{
    way w = {.arena_q8 = take8(in), .beyond = take8(in), .fill = take8(in), .moves = take8(in)};
    w.workers = (uint8_t)(1 + below(in, MOST_WORKERS_DRAWN));
    w.order = take8(in);
    w.cpu = take8(in);
    w.strips = take8(in);
    w.heights[0] = take8(in);
    w.heights[1] = take8(in);
    w.abandons = take8(in);
    w.padding = (uint8_t)below(in, 9);
    w.room = take8(in);
    w.cancels = (uint8_t)below(in, 12);
    w.cancels_q8 = take8(in);
    const uint32_t before = below(in, 32); /* this takes time */
    w.before = (uint8_t)(before < 8 ? before : 0);
    return w;
}

/* X(bytes of a way, their effect), to find the ones that cause a difference. */
#define PARTS(X)                                                                                                       \
    X(arena_q8, "the arena's size")                                                                                    \
    X(beyond, "bytes beyond the arena for full speed")                                                                 \
    X(fill, "what the memory held before")                                                                             \
    X(moves, "the arena's place")                                                                                      \
    X(workers, "workers")                                                                                              \
    X(order, "the order of tasks")                                                                                     \
    X(cpu, "the processor's variants")                                                                                 \
    X(strips, "strips")                                                                                                \
    X(abandons, "a view that came in part")                                                                            \
    X(padding, "bytes between rows")                                                                                   \
    X(room, "room that settings leave")                                                                                \
    X(cancels, "a cancelled call")                                                                                     \
    X(before, "what the arena was used for before")
#define PART(member, text) {offsetof(way, member), text},
static const struct {
    size_t at;
    const char *text;
} parts[] = {PARTS(PART)};
enum { PARTS_COUNT = sizeof parts / sizeof *parts };

static uint8_t part_of(const way *w, size_t part)
{
    return ((const uint8_t *)w)[parts[part].at];
}

/* ---- results of a run ---------------------------------------------------------------------------- */

typedef struct note {
    const char *call, *what; /* "t3r_render", "the colours" */
    uint32_t number;         /* of the call */
    size_t at, bytes;
} note;

enum { MOST_NOTES = 2048 };

typedef struct trace {
    note notes[MOST_NOTES];
    uint32_t count;
    uint8_t *memory;
    size_t bytes, room;
    uint32_t steps[MOST_CALLS]; /* reported by each call */
} trace;

static void add_note(trace *t, note n, const void *data)
{
    REQUIRE(t->count < MOST_NOTES);
    if (t->bytes + n.bytes > t->room) {
        t->room = 2 * (t->bytes + n.bytes);
        t->memory = realloc(t->memory, t->room);
        REQUIRE(t->memory != NULL);
    }
    memcpy(t->memory + t->bytes, data, n.bytes);
    n.at = t->bytes;
    t->bytes += n.bytes;
    t->notes[t->count++] = n;
}

/* Drops all notes but the first `count`. */
static void rewind_to(trace *t, uint32_t count)
{
    t->bytes = count < t->count ? t->notes[count].at : t->bytes;
    t->count = count;
}

#define FIELD(member) {offsetof(t3r_gaussian, member) + sizeof(((t3r_gaussian *)NULL)->member), #member},
static const struct {
    size_t end;
    const char *name;
} gaussian_fields[] = {FIELD(position_q20) FIELD(factor) FIELD(factor_exponent) FIELD(view) FIELD(colour_q7)
                           FIELD(opacity_q15) FIELD(confidence) FIELD(reserved)};

static const char *const the_gaussians = "the Gaussians";

static void describe_bytes(const note *n, const uint8_t *is, const uint8_t *expected)
{
    size_t at = 0;
    while (is[at] == expected[at]) {
        at++;
    }
    fprintf(stderr, "other bits of %s from byte %zu of %zu on: %02x, not %02x", n->what, at, n->bytes, is[at],
            expected[at]);
    if (n->what == the_gaussians) {
        size_t field = 0;
        while (gaussian_fields[field].end <= at % sizeof(t3r_gaussian)) {
            field++;
        }
        fprintf(stderr, "; this is %s of Gaussian %zu", gaussian_fields[field].name, at / sizeof(t3r_gaussian));
    }
    fprintf(stderr, "\n");
}

static bool is_same(const trace *t, const note *n, const trace *expected, const note *e)
{
    return n->what == e->what && n->number == e->number && n->bytes == e->bytes &&
           memcmp(t->memory + n->at, expected->memory + e->at, n->bytes) == 0;
}

static uint32_t first_difference(const trace *t, const trace *expected)
{
    uint32_t i = 0;
    while (i < t->count && i < expected->count && is_same(t, &t->notes[i], expected, &expected->notes[i])) {
        i++;
    }
    return i;
}

static bool agree(const trace *t, const trace *expected)
{
    return t->count == expected->count && first_difference(t, expected) == t->count;
}

static void describe_difference(const trace *t, const trace *expected)
{
    const uint32_t first = first_difference(t, expected);
    if (first == t->count || first == expected->count) {
        const note *n = first == t->count ? &expected->notes[first] : &t->notes[first];
        fprintf(stderr, "settings: call %u, %s: only %s way has %s\n", n->number, n->call,
                first == t->count ? "the plain" : "this", n->what);
        return;
    }
    const note *n = &t->notes[first], *e = &expected->notes[first];
    fprintf(stderr, "settings: call %u, %s: ", n->number, n->call);
    if (n->what == e->what && n->bytes == e->bytes) {
        describe_bytes(n, t->memory + n->at, expected->memory + e->at);
    } else if (n->what == e->what) {
        fprintf(stderr, "%zu bytes of %s, not %zu\n", n->bytes, n->what, e->bytes);
    } else {
        fprintf(stderr, "%s is here, not %s\n", n->what, e->what);
    }
}

/* ---- a run --------------------------------------------------------------------------------------- */

typedef struct run {
    const drawn_case *drawn;
    way goes;
    const trace *expected; /* of the plain way; NULL: this is the plain way */
    trace *seen;
    t3r_config config;
    uint8_t *arena;
    size_t bytes;
    t3r_runtime *rt;
    const char *name; /* of the call */
    uint32_t call;    /* its number */
    uint32_t steps;   /* that it reported */
    uint32_t ends_at; /* the step that cancels it; 0 = none */
    uint32_t index;   /* of the frame that it takes */
    const t3r_request *request;
} run;

static void see(run *r, const char *what, const void *data, size_t bytes)
{
    add_note(r->seen, (note){.call = r->name, .what = what, .number = r->call, .bytes = bytes}, data);
}

static void see_number(run *r, const char *what, uint32_t number)
{
    see(r, what, &number, sizeof number);
}

static int count_steps(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    run *r = user;
    REQUIRE(stage < T3R_STAGE_COUNT && done <= total);
    return ++r->steps == r->ends_at;
}

static void see_hash(void *user, t3r_stage stage, uint64_t hash)
{
    see(user, t3r_stage_name(stage), &hash, sizeof hash);
}

static uint32_t common_divisor(uint32_t a, uint32_t b)
{
    return b == 0 ? a : common_divisor(b, a % b);
}

/* Runs each task once, in order, backwards or in leaps, with any worker. */
static void run_tasks(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                      void *context)
{
    const run *r = user;
    const uint32_t seed = r->goes.order;
    uint32_t leap = seed % 4 == 1 ? count - 1 : seed % 4 == 0 ? 1 : 1 + seed / 4;
    while (common_divisor(leap, count) != 1) {
        leap++;
    }
    for (uint32_t i = 0, index = seed % 2 ? count - 1 : 0; i < count; i++) {
        task(context, index, t3r_mix32(seed << 16 ^ i) % r->config.workers);
        index = (index + leap) % count;
    }
}

static uint32_t features_of(const way *goes, uint32_t call)
{
    const uint32_t has = t3r_cpu_features(), choice = goes->cpu == 0 ? 0 : (goes->cpu + call) % 8;
    const uint32_t masks[] = {0,
                              T3R_CPU_SSE41,
                              T3R_CPU_SSE41 | T3R_CPU_AVX2,
                              ~(uint32_t)T3R_CPU_VNNI,
                              UINT32_MAX,
                              t3r_mix32(goes->cpu),
                              UINT32_MAX,
                              UINT32_MAX};
    return has & masks[choice];
}

/* Draws a configuration that may differ only as the library's documentation allows; a part is 0 where it does not
 * differ. */
static t3r_config config_of(const drawn_case *c, const way *goes)
{
    t3r_config k = c->config;
    const bool built_once = c->tells == ONE_BUILD && k.depth == T3R_DEPTH_SENSOR;
    k.workers = goes->workers;
    k.max_gaussians += goes->room & ROOM_GAUSSIANS ? 37 : 0;
    k.render_width += goes->room & ROOM_TARGET ? 9 : 0;
    k.render_height += goes->room & ROOM_TARGET ? 5 : 0;
    k.keep_analysis |= (goes->room & ROOM_ANALYSIS) != 0;
    k.head_column_bytes += goes->room & ROOM_COLUMN && k.head_column_bytes > 0 ? 100 : 0;
    k.tile_splats = goes->room & ROOM_TILE && k.tile_splats == 0 ? T3R_MAX_GAUSSIANS : k.tile_splats;
    k.warm |= goes->room & ROOM_WARM && built_once;
    k.views += goes->room & ROOM_VIEWS && built_once && k.clusters != 0 && k.cluster_batches != 0;
    return k;
}

/* Restores the bindings that a move or a cancelled call loses. */
static void bind(run *r)
{
    const t3r_hooks hooks = {.user = r,
                             .progress = count_steps,
                             .stage_hash = see_hash,
                             .parallel_for = r->goes.workers > 1 ? run_tasks : NULL};
    REQUIRE(t3r_set_hooks(r->rt, &hooks) == T3R_OK);
    REQUIRE(t3r_set_cpu(r->rt, features_of(&r->goes, r->call)) == T3R_OK);
    REQUIRE(t3r_bind_head(r->rt, r->drawn->weights, r->drawn->weights_bytes) == T3R_OK);
}

static void move(run *r)
{
    uint8_t *moved = allocate_arena(r->bytes);
    memcpy(moved, r->arena, r->bytes);
    free(r->arena);
    r->arena = moved;
    const t3r_status status = t3r_attach(&r->rt, r->arena, r->bytes);
    if (status != T3R_OK) {
        fprintf(stderr, "settings: call %u, %s: the arena is refused in its new place: %s\n", r->call, r->name,
                t3r_error_text(status));
        abort();
    }
}

typedef t3r_status action(run *r);

/* Performs a call and notes its status. If it may be cancelled, the next call does the whole work. */
static t3r_status perform(run *r, const char *name, action *act, bool may_be_cancelled)
{
    r->name = name;
    r->call++;
    REQUIRE(r->call < MOST_CALLS);
    if (r->goes.moves >> r->call % 8 & 1) {
        move(r);
    }
    bind(r);
    r->steps = r->ends_at = 0;
    const uint32_t before = r->seen->count;
    if (r->call == r->goes.cancels && may_be_cancelled) {
        r->ends_at = 1 + r->expected->steps[r->call] * r->goes.cancels_q8 / 256;
    }
    t3r_status status = act(r);
    if (r->ends_at > 0 && status == T3R_ERR_CANCELLED) {
        rewind_to(r->seen, before);
        r->ends_at = 0;
        status = act(r);
    }
    r->seen->steps[r->call] = r->steps;
    require_status(status);
    see(r, "the status", &status, sizeof status);
    return status;
}

/* ---- calls --------------------------------------------------------------------------------------- */

static uint32_t rows_of_strip(const run *r, const t3r_frame *frame)
{
    return (1 + r->goes.heights[0] % 40u) * (frame->format == T3R_PIXEL_NV12 ? 2 : 1);
}

/* Adds colour and depth each in strips of their own height. */
static t3r_status add_strips(run *r, const t3r_frame *f)
{
    const uint32_t rows = rows_of_strip(r, f), depth_rows = 1 + r->goes.heights[1] % 40u;
    t3r_status status = T3R_OK;
    for (uint32_t row = 0, depth_row = 0; status == T3R_OK && (row < f->height || depth_row < f->depth_height);) {
        const uint32_t now = T3R_MIN(rows, f->height - row);
        const uint32_t depth_now = T3R_MIN(depth_rows, f->depth_height - depth_row);
        t3r_frame part = *f;
        part.planes[0] += (size_t)row * f->stride_bytes[0];
        if (f->planes[1] != NULL) {
            part.planes[1] += (size_t)(row / 2) * f->stride_bytes[1];
        }
        part.depth += (size_t)depth_row * f->depth_stride_bytes;
        const bool counts = now > 0 || r->config.depth == T3R_DEPTH_SENSOR; /* stereo ignores remaining depth */
        if (counts) {
            status = t3r_add_rows(r->rt, &part, &r->drawn->camera[r->index], row, now, depth_row, depth_now);
        }
        row += now;
        depth_row += depth_now;
    }
    return status;
}

/* Adds only a part, so that no view is added. */
static void abandon_strip(run *r, const t3r_frame *f)
{
    const uint32_t rows = T3R_MIN(rows_of_strip(r, f), f->height - 2);
    (void)t3r_add_rows(r->rt, f, &r->drawn->camera[r->index], 0, rows, 0, 0);
}

/* Adds a view; with `warm` a view in strips may not replace another one. */
static t3r_status add_view(run *r)
{
    held_frame held = frame_of(r->drawn, r->index, r->goes.padding);
    const bool replaces = r->index >= r->config.views;
    if (r->goes.abandons >> r->index & 1 && !replaces) {
        abandon_strip(r, &held.frame);
    }
    const t3r_status status = r->goes.strips >> r->index & 1 && !replaces
                                  ? add_strips(r, &held.frame)
                                  : t3r_add_view(r->rt, &held.frame, &r->drawn->camera[r->index]);
    free_frame(&held);
    return status;
}

static void see_scene(run *r, const t3r_scene *scene)
{
    for (uint32_t i = 0; i < 3; i++) {
        see(r, "the origin", &scene->frame.origin_q32[i], sizeof scene->frame.origin_q32[i]);
    }
    see_number(r, "the exponent", (uint32_t)scene->frame.exponent);
    see_number(r, "the number of Gaussians", scene->count);
    see_number(r, "the number of valid points", scene->valid_points);
    see(r, the_gaussians, scene->gaussians, scene->count * sizeof *scene->gaussians);
}

static t3r_request request_of(const run *r)
{
    t3r_request q = *r->request;
    if (r->goes.room & ROOM_REQUEST) {
        q.gaussians = q.gaussians != 0 ? q.gaussians : r->config.gaussians;
        q.allocate = q.allocate != 0 ? q.allocate : r->config.allocate;
        q.head = q.head != 0 ? q.head : r->config.head;
    }
    return q;
}

static t3r_status build_with(run *r, t3r_status build(t3r_runtime *, const t3r_request *, t3r_scene *))
{
    const t3r_request request = request_of(r);
    t3r_scene scene;
    const t3r_status status = build(r->rt, &request, &scene);
    if (status == T3R_OK) {
        see_scene(r, &scene);
        see_number(r, "the refinement passes", t3r_refinement_passes(r->rt));
    }
    for (uint32_t v = 0; v < r->drawn->config.views && status != T3R_ERR_CANCELLED; v++) {
        uint32_t partner;
        see_number(r, "what a view can be matched with", (uint32_t)t3r_stereo_pair(r->rt, v, &partner));
        see_number(r, "the partner of a view", partner);
    }
    return status;
}

static t3r_status reconstruct(run *r)
{
    return build_with(r, t3r_reconstruct);
}

static t3r_status rebuild(run *r)
{
    return build_with(r, t3r_rebuild);
}

/* Notes only the rows, and checks that the bytes between them do not change. */
static void see_plane(run *r, const char *what, const void *plane, size_t row, size_t stride)
{
    for (uint32_t y = 0; y < r->drawn->eye_height; y++) {
        const uint8_t *at = (const uint8_t *)plane + y * stride;
        see(r, what, at, row);
        for (size_t i = row; i < stride && y + 1 < r->drawn->eye_height; i++) {
            REQUIRE(at[i] == 0);
        }
    }
}

static t3r_status render(run *r)
{
    const uint32_t width = r->drawn->eye_width;
    picture drawn = picture_of(width, r->drawn->eye_height, r->goes.padding);
    const t3r_status status = t3r_render(r->rt, &r->drawn->eye, &drawn.target);
    if (status == T3R_OK) {
        const t3r_target *t = &drawn.target;
        see_plane(r, "the colours", t->rgb, width * (size_t)3, t->rgb_stride_bytes);
        see_plane(r, "the depths", t->depth_q20, width * sizeof *t->depth_q20, t->depth_stride_bytes);
        see_plane(r, "the alphas", t->alpha_q15, width * sizeof *t->alpha_q15, t->alpha_stride_bytes);
    }
    free_picture(&drawn);
    return status;
}

static t3r_status take_keyframe(run *r)
{
    held_frame held = frame_of(r->drawn, r->index, r->goes.padding);
    t3r_stream_report report;
    const t3r_status status = t3r_stream_keyframe(r->rt, &held.frame, &r->drawn->camera[r->index], &report);
    free_frame(&held);
    see(r, "the report", &report, sizeof report);
    uint32_t overlap_q8 = 0;
    const t3r_status asked =
        t3r_stream_overlap(r->rt, &r->drawn->eye, r->drawn->eye_width + 1, r->drawn->eye_height + 1, &overlap_q8);
    see_number(r, "the overlap's status", (uint32_t)asked);
    see_number(r, "the overlap", overlap_q8);
    return status;
}

static t3r_status get_scene(run *r)
{
    t3r_scene scene;
    const t3r_status status = t3r_get_scene(r->rt, &scene);
    if (status == T3R_OK) {
        see_scene(r, &scene);
    }
    return status;
}

/* ---- the way through a case ---------------------------------------------------------------------- */

/* Builds and draws. A build may be cancelled if the next one starts from scratch in any case. */
static void build_and_look(run *r, bool follows)
{
    r->request = &r->drawn->first;
    perform(r, "t3r_reconstruct", reconstruct, !follows);
    perform(r, "t3r_render", render, true);
    if (r->drawn->again.gaussians > 0) {
        r->request = &r->drawn->again;
        perform(r, "t3r_rebuild", rebuild, true);
        perform(r, "t3r_render", render, true);
    }
}

/* Makes at most `most` calls for frames. */
static void go_through(run *r, uint32_t most)
{
    const drawn_case *c = r->drawn;
    for (uint32_t i = 0; i < c->frames && i < most; i++) {
        r->index = i;
        if (c->tells == STREAM) {
            perform(r, "t3r_stream_keyframe", take_keyframe, false);
            continue;
        }
        perform(r, "t3r_add_view", add_view, false);
        if (i + 1 >= c->config.views) {
            build_and_look(r, i + 1 > c->config.views);
        }
    }
    perform(r, "t3r_get_scene", get_scene, false);
    perform(r, "t3r_render", render, true);
}

static void go(const drawn_case *c, way goes, const trace *expected, trace *seen)
{
    run r = {.drawn = c, .goes = goes, .expected = expected, .seen = seen, .config = config_of(c, &goes)};
    rewind_to(seen, 0);
    seen->bytes = 0;
    size_t least, full;
    REQUIRE(t3r_plan_bytes(&r.config, &least, &full) == T3R_OK);
    r.bytes = least + (full - least) * goes.arena_q8 / FULL_Q8 + goes.beyond;
    r.arena = allocate_arena(r.bytes);
    memset(r.arena, goes.fill, r.bytes);
    REQUIRE(t3r_init(&r.rt, r.arena, r.bytes, &r.config) == T3R_OK);
    REQUIRE(t3r_set_ablation(r.rt, &c->ablation) == T3R_OK);
    if (goes.before > 0) {
        r.goes.cancels = 0;
        go_through(&r, goes.before - 1u);
        REQUIRE(t3r_reset(r.rt) == T3R_OK);
        rewind_to(seen, 0);
        r.call = 0;
        r.goes.cancels = goes.cancels;
    }
    go_through(&r, UINT32_MAX);
    free(r.arena);
}

/* ---- findings ------------------------------------------------------------------------------------ */

/* Makes every unnecessary difference plain, part by part, and names the rest. */
static void blame(const drawn_case *c, way goes, const trace *expected, trace *seen)
{
    for (size_t i = 0; i < PARTS_COUNT; i++) {
        way less = goes;
        ((uint8_t *)&less)[parts[i].at] = part_of(&plain, i);
        go(c, less, expected, seen);
        goes = agree(seen, expected) ? goes : less;
    }
    go(c, goes, expected, seen);
    describe_difference(seen, expected);
    for (size_t i = 0; i < PARTS_COUNT; i++) {
        if (part_of(&goes, i) != part_of(&plain, i)) {
            fprintf(stderr, "settings: it takes %s: %u\n", parts[i].text, part_of(&goes, i));
        }
    }
    const t3r_config k = config_of(c, &goes);
    fprintf(stderr,
            "settings: %ux%u, %u views, %u of %u Gaussians, wavelet %s of %u levels, %u clusters in %u batches, %s, "
            "head %s, "
            "refine %u%s%s%s, depth by %s%s%s%s%s\n",
            k.width, k.height, k.views, k.gaussians, k.max_gaussians, t3r_wavelet_name(k.wavelet), k.levels, k.clusters,
            k.cluster_batches, t3r_allocation_name(k.allocate), t3r_head_name(k.head), k.refine,
            k.fit_passes ? " at most" : "", k.structural ? " (structural)" : "", k.fit_widths ? ", widths fitted" : "",
            t3r_depth_name(k.depth), k.align ? ", aligned" : "", k.keep_analysis ? ", analysis kept" : "",
            k.warm ? ", warm" : "", k.stream ? ", a stream" : "");
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    static trace expected, seen;
    input in = {bytes, count};
    const way goes = take_way(&in);
    drawn_case c;
    draw_case(&in, &c);
    go(&c, plain, NULL, &expected);
    go(&c, goes, &expected, &seen);
    if (!agree(&seen, &expected)) {
        blame(&c, goes, &expected, &seen);
        abort();
    }
    free_case(&c);
    return 0;
}
