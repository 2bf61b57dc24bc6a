/* SPDX-License-Identifier: Apache-2.0 */
/* The firmware of every board: reads a recording by strips of rows; outputs Gaussians, a view and every stage's hash.
 * Words on the command line, each KEY=NUMBER or a file, describe the build; the defaults are those of
 * t3r_default_config().
 *
 *     frames=IN.mcap view=OUT.ppm scene=OUT.t3g width=64 height=64 views=2 gaussians=819 clusters=32 refine=2
 *     learned=1 hashes=1 plain=0 cpu=T3R_CPU_... arena=BYTES
 *
 * The first `views` frames are the context; the next one's camera is drawn. */
#include <stdbool.h>

#include "core/hash.h"
#include "frames.h"
#include "marks.h"
#include "options.h"
#include "ram.h"
#include "report.h"
#include "semihost.h"
#include "stack.h"
#include "text_length.h"
#include "trim3r.h"
#ifdef HEAD
#include "trim3r_heads.h"
#endif

#define STRIP_ROWS 8u /* rows of a frame that are in memory at once */

/* The hash of each stage; the reports of a stage that reports several times are chained. */
typedef struct hashes {
    uint64_t of[T3R_STAGE_COUNT];
    bool there[T3R_STAGE_COUNT];
} hashes;

/* Allocates from the front of the free memory. */
static uint8_t *deal(ram_part *left, size_t bytes)
{
    uint8_t *dealt = left->begin;
    bytes = (bytes + T3R_ARENA_ALIGN - 1) / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN;
    if ((size_t)(left->end - left->begin) < bytes) {
        report_failure("memory lacks this many bytes:", (uint32_t)(bytes - (size_t)(left->end - left->begin)));
    }
    left->begin += bytes;
    return dealt;
}

static void check(t3r_status status, const char *function)
{
    if (status != T3R_OK) {
        report_refusal(function, (uint32_t) - (int32_t)status); /* t3r_error_text() would add more than a kilobyte */
    }
}

static int on_progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    (void)user, (void)done, (void)total;
    mark_stage(stage);
    return 0;
}

static void on_hash(void *user, t3r_stage stage, uint64_t hash)
{
    hashes *h = user;
    h->of[stage] = h->there[stage] ? t3r_hash_u64(h->of[stage], hash) : hash;
    h->there[stage] = true;
}

/* Reports the hash of each stage, and one for all stages and the view: the hash that `trim3r replay` prints. */
static void report_hashes(const hashes *h, const uint8_t *view, size_t bytes)
{
    uint64_t whole = T3R_HASH_START;
    for (uint32_t stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        if (h->there[stage]) {
            report_hash(t3r_stage_name((t3r_stage)stage), h->of[stage]);
            whole = t3r_hash_u64(t3r_hash_u8(whole, (uint8_t)stage), h->of[stage]);
        }
    }
    report_hash("final", t3r_hash_bytes(whole, view, bytes));
}

static t3r_config configure(const options *o)
{
    t3r_config config = t3r_default_config(o->width, o->height, o->views, o->gaussians);
    config.clusters = o->clusters != 0 ? o->clusters : config.clusters;
    config.cluster_batches = o->cluster_batches != 0 ? o->cluster_batches : config.cluster_batches;
    config.refine = o->refine;
    /* the same work and bits for every set of features in the library */
    config.fit_passes = config.fit_widths = config.align = 0;
#ifdef HEAD
    if (o->learned != 0) {
        config.head = T3R_HEAD_LEARNED;
        config.head_column_bytes = t3r_head_column_bytes(HEAD, HEAD_BYTES, o->width);
    }
#endif
    return config;
}

/* Chooses the kernels named on the command line, or those for this core as far as the compiler knows it. PLAIN_C links
 * none, for small firmware. */
static t3r_status choose_kernels(t3r_runtime *rt, uint32_t cpu)
{
    (void)rt, (void)cpu;
#if defined(PLAIN_C)
    return T3R_OK;
#elif defined(__ARM_FEATURE_MVE)
    return t3r_set_cpu(rt, T3R_CPU_MVE);
#elif defined(__ARM_FEATURE_DSP)
    return t3r_set_cpu(rt, T3R_CPU_DSP);
#elif defined(__wasm_simd128__)
    return t3r_set_cpu(rt, T3R_CPU_SIMD128);
#else
    return t3r_set_cpu(rt, cpu);
#endif
}

static void write_file(const char *path, const char *head, const void *bytes, size_t count)
{
    const int32_t file = semihost_open(path, SEMIHOST_WRITE);
    if (file <= 0 || semihost_write(file, head, text_length(head)) != 0 || semihost_write(file, bytes, count) != 0) {
        report_text("error: ", path, ": it cannot be written", "");
        semihost_exit(1);
    }
    semihost_close(file);
}

/* Adds a view in strips, as a camera delivers it: only one strip is in memory. */
static void add_view(t3r_runtime *rt, uint32_t height)
{
    t3r_frame frame;
    t3r_camera camera;
    frames_next(&frame, &camera);
    for (uint32_t row = 0; row < height; row += STRIP_ROWS) {
        const uint32_t rows = height - row < STRIP_ROWS ? height - row : STRIP_ROWS;
        mark_other();
        frames_rows(&frame, row, rows);
        mark_stage(T3R_STAGE_IMAGE);
        check(t3r_add_rows(rt, &frame, &camera, row, rows, row, rows), "t3r_add_rows");
    }
}

int main(void)
{
    static options o;
    ram_part left = ram_free();
    options_read(&o);
    const size_t pixels = (size_t)o.width * o.height;
    uint8_t *picture = deal(&left, pixels * 3);
    const size_t strip_pixels = (size_t)STRIP_ROWS * o.width;
    uint8_t *strip_room = deal(&left, strip_pixels * 5);
    const frames_strip strip = {strip_room, strip_room + strip_pixels * 3, STRIP_ROWS};
    frames_open(o.frames, o.width, o.height, &strip);

    const t3r_config config = configure(&o);
    size_t least = 0, most = 0;
    check(t3r_plan_bytes(&config, &least, &most), "t3r_plan_bytes");
    const size_t room = (size_t)(left.end - left.begin) / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN;
    const size_t bytes = o.arena != 0 ? o.arena : most < room ? most : room;
    if (bytes < least) {
        report_failure("memory lacks this many bytes:", (uint32_t)(least - bytes));
    }
    t3r_runtime *rt;
    check(t3r_init(&rt, deal(&left, bytes), bytes, &config), "t3r_init");
    if (o.plain == 0) {
        check(choose_kernels(rt, o.cpu), "t3r_set_cpu");
    }
    static hashes heard;
    const t3r_hooks hooks = {.user = &heard, .progress = on_progress, .stage_hash = o.hashes != 0 ? on_hash : NULL};
    check(t3r_set_hooks(rt, &hooks), "t3r_set_hooks");
#ifdef HEAD
    if (o.learned != 0) {
        check(t3r_bind_head(rt, HEAD, HEAD_BYTES), "t3r_bind_head");
    }
#endif

    for (uint32_t view = 0; view < o.views; view++) {
        add_view(rt, o.height);
    }
    t3r_scene scene = {0};
    check(t3r_reconstruct(rt, NULL, &scene), "t3r_reconstruct");
    mark_other();
    if (o.scene[0] != '\0') {
        write_file(o.scene, "", scene.gaussians, scene.count * sizeof *scene.gaussians);
    }
    t3r_frame frame;
    t3r_camera camera;
    frames_next(&frame, &camera);
    const t3r_target target = {.width = o.width, .height = o.height, .rgb = picture, .rgb_stride_bytes = o.width * 3};
    check(t3r_render(rt, &camera, &target), "t3r_render");
    mark_other();
    if (o.view[0] != '\0') {
        write_file(o.view, report_ppm_head(o.width, o.height), picture, pixels * 3);
    }
    if (o.hashes != 0) {
        report_hashes(&heard, picture, pixels * 3);
    }
    report_number("gaussians", scene.count);
    report_number("arena_bytes", (uint32_t)bytes);
    report_number("arena_min_bytes", (uint32_t)least);
    report_number("data_bytes", (uint32_t)(ram_data().end - ram_data().begin));
    report_number("memory_bytes", (uint32_t)(left.begin - ram_free().begin));
    report_number("stack_bytes", stack_used_bytes());
    report_number("stack_room_bytes", stack_bytes());
    return 0;
}
