/* SPDX-License-Identifier: Apache-2.0 */
/* The runtime as a WebAssembly module, called by the page's worker. The worker places the bundle and the arena in the
 * module's memory, which the worker grows; the module has no heap. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "bundle_layout.h"
#include "core/hash.h"
#include "core/memory.h"
#include "scene/seen_gaussian.h"
#include "state/state.h"
#include "state/views.h"
#include "trim3r.h"

#define EXPORT(name) __attribute__((export_name(#name)))
#define IMPORT(name) __attribute__((import_module("page"), import_name(#name)))

IMPORT(progress) extern int32_t page_progress(int32_t stage, uint32_t done, uint32_t total);
IMPORT(stage_ends) extern void page_stage_ends(int32_t stage);

typedef void task(void *context, uint32_t index, uint32_t worker);
IMPORT(parallel_for) extern void page_parallel_for(uint32_t count, task *work, void *context);

/* Runs one task of page_parallel_for(), in any thread. */
EXPORT(run) void module_run(task *work, void *context, uint32_t index, uint32_t worker)
{
    work(context, index, worker);
}

/* ---- reading the bundle ------------------------------------------------------------------------------------------ */

typedef struct frame_data {
    t3r_camera camera;
    uint64_t depth_unit_q40;
    const uint8_t *rgb, *depth; /* depth: NULL = none */
} frame_data;

typedef struct reading {
    const uint8_t *start;
    size_t at, count;
    int32_t broken; /* 1 = the bundle ended too early */
} reading;

/* The module keeps one bundle and one runtime: a page shows one scene. */
static struct {
    t3r_config config;
    uint32_t frames;
    frame_data frame[BUNDLE_MOST_FRAMES];
    const uint8_t *weights, *gaussians, *harmonics;
    uint32_t weight_bytes, gaussian_count;
    t3r_scene_frame scene_frame;
    seen_traits traits;
    t3r_runtime *runtime;
    t3r_scene scene;
    uint64_t hash[T3R_STAGE_COUNT];
    uint8_t hashed[T3R_STAGE_COUNT];
    bool loaded; /* the scene in the arena is the bundle's, not one that was built */
} module;

static const uint8_t *take(reading *in, size_t bytes)
{
    if (bytes > in->count - in->at) {
        in->broken = 1;
        in->at = in->count;
        return in->start;
    }
    const uint8_t *taken = in->start + in->at;
    in->at += bytes;
    return taken;
}

static uint64_t take_number(reading *in, uint32_t bytes)
{
    const uint8_t *from = take(in, bytes);
    uint64_t value = 0;
    for (uint32_t i = 0; i < bytes && !in->broken; i++) {
        value |= (uint64_t)from[i] << (8 * i);
    }
    return value;
}

static uint32_t take_u32(reading *in)
{
    return (uint32_t)take_number(in, 4);
}

static const uint8_t *take_block(reading *in, size_t bytes)
{
    (void)take(in, (BUNDLE_ALIGN - in->at % BUNDLE_ALIGN) % BUNDLE_ALIGN);
    return take(in, bytes);
}

static void take_config(reading *in, t3r_config *config)
{
    uint32_t *words = (uint32_t *)config; /* a struct of 32-bit words: bundle_layout.h */
    in->broken |= take_u32(in) != BUNDLE_CONFIG_WORDS;
    for (uint32_t i = 0; i < BUNDLE_CONFIG_WORDS; i++) {
        words[i] = take_u32(in);
    }
}

static void take_frame(reading *in, frame_data *frame)
{
    t3r_camera *c = &frame->camera;
    *c = (t3r_camera){0};
    c->fx_q16 = (int32_t)take_u32(in);
    c->fy_q16 = (int32_t)take_u32(in);
    c->cx_q16 = (int32_t)take_u32(in);
    c->cy_q16 = (int32_t)take_u32(in);
    for (int i = 0; i < 3; i++) {
        c->position_q32[i] = (int64_t)take_number(in, 8);
    }
    for (int i = 0; i < 4; i++) {
        c->rotation_q30[i] = (int32_t)take_u32(in);
    }
    frame->depth_unit_q40 = take_number(in, 8);
}

static void take_pixels(reading *in, frame_data *frame, size_t pixels)
{
    frame->rgb = take_block(in, pixels * 3);
    frame->depth = frame->depth_unit_q40 != 0 ? take_block(in, pixels * 2) : NULL;
}

/* Returns the bytes of a Gaussian's harmonics. */
static size_t harmonics_bytes(void)
{
    const size_t rows = module.traits.degree + 1;
    return module.traits.degree == 0 ? 0 : 2 * 3 * rows * rows;
}

static int32_t read_bundle(reading *in)
{
    if (take_u32(in) != BUNDLE_MAGIC) {
        return 0;
    }
    take_config(in, &module.config);
    const uint32_t views = take_u32(in);
    module.frames = take_u32(in);
    module.weight_bytes = take_u32(in);
    module.gaussian_count = take_u32(in);
    module.scene_frame.exponent = (int32_t)take_u32(in);
    for (int i = 0; i < 3; i++) {
        module.scene_frame.origin_q32[i] = (int64_t)take_number(in, 8);
    }
    module.traits.degree = take_u32(in);
    module.traits.mip = take_u32(in) != 0;
    if (in->broken || module.frames > BUNDLE_MOST_FRAMES || views > module.frames || views != module.config.views ||
        module.gaussian_count > T3R_MAX_GAUSSIANS || module.traits.degree > T3R_HARMONICS_DEGREE_MOST ||
        module.config.width > T3R_MAX_SIDE || module.config.height > T3R_MAX_SIDE) {
        return 0;
    }
    for (uint32_t i = 0; i < module.frames; i++) {
        take_frame(in, &module.frame[i]);
    }
    module.weights = take_block(in, module.weight_bytes);
    for (uint32_t i = 0; i < module.frames; i++) {
        take_pixels(in, &module.frame[i], (size_t)module.config.width * module.config.height);
    }
    module.gaussians = take_block(in, (size_t)module.gaussian_count * BUNDLE_GAUSSIAN_BYTES);
    module.harmonics = take_block(in, (size_t)module.gaussian_count * harmonics_bytes());
    return !in->broken;
}

/* ---- the runtime ------------------------------------------------------------------------------------------------- */

static int report_progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    (void)user;
    return page_progress(stage, done, total);
}

/* Keeps a stage's hash as `trim3r replay` does: the reports of a stage that reports several times are chained. */
static void keep_hash(void *user, t3r_stage stage, uint64_t hash)
{
    (void)user;
    module.hash[stage] = module.hashed[stage] ? t3r_hash_u64(module.hash[stage], hash) : hash;
    module.hashed[stage] = 1;
    page_stage_ends(stage);
}

static void share(void *user, uint32_t count, task *work, void *context)
{
    (void)user;
    page_parallel_for(count, work, context);
}

static const t3r_hooks building = {.progress = report_progress, .stage_hash = keep_hash, .parallel_for = share};
static const t3r_hooks drawing = {.parallel_for = share};

/* Opens the bundle at this address, aligned to 16, which must stay in the module's memory; targets are at most of this
 * size. builds: 1 = it builds scenes, 0 = it only draws, in a smaller arena. workers: threads that page_parallel_for()
 * has. Returns the bytes of the arena that it needs; 0 = the bundle is damaged or its configuration refused. */
EXPORT(open)
uint32_t module_open(const uint8_t *bundle, uint32_t bytes, uint32_t render_width, uint32_t render_height,
                     uint32_t builds, uint32_t workers)
{
    reading in = {.start = bundle, .count = bytes};
    t3r_plan_info plan;
    if (!read_bundle(&in)) {
        return 0;
    }
    if (builds == 0) {
        module.config.views = 0;
        module.weight_bytes = 0;
    }
    module.config.workers = workers;
    module.config.render_width = render_width;
    module.config.render_height = render_height;
    return t3r_plan(&module.config, &plan) == T3R_OK ? (uint32_t)plan.bytes : 0;
}

/* Initialises the arena at this address, aligned to 64. Returns a t3r_status. */
EXPORT(start) int32_t module_start(void *arena, uint32_t bytes)
{
    t3r_status status = t3r_init(&module.runtime, arena, bytes, &module.config);
    if (status == T3R_OK) {
        status = t3r_set_cpu(module.runtime, t3r_cpu_found());
    }
    if (status == T3R_OK) {
        status = t3r_set_hooks(module.runtime, &drawing);
    }
    if (status == T3R_OK && module.weight_bytes > 0) {
        status = t3r_bind_head(module.runtime, module.weights, module.weight_bytes);
    }
    return status;
}

/* Returns the features that the inner loops use, T3R_CPU_... */
EXPORT(cpu) uint32_t module_cpu(void)
{
    return t3r_get_cpu(module.runtime);
}

static t3r_gaussian gaussian_at(uint32_t index)
{
    reading in = {.start = module.gaussians + (size_t)index * BUNDLE_GAUSSIAN_BYTES, .count = BUNDLE_GAUSSIAN_BYTES};
    t3r_gaussian g = {0};
    for (int i = 0; i < 3; i++) {
        g.position_q20[i] = (int32_t)take_u32(&in);
    }
    for (int i = 0; i < 9; i++) {
        g.factor[i] = (int16_t)take_number(&in, 2);
    }
    g.factor_exponent = (int8_t)take_number(&in, 1);
    g.view = (uint8_t)take_number(&in, 1);
    for (int i = 0; i < 3; i++) {
        g.colour_q7[i] = (uint16_t)take_number(&in, 2);
    }
    g.opacity_q15 = (uint16_t)take_number(&in, 2);
    g.confidence = (uint8_t)take_number(&in, 1);
    return g;
}

static bool depends_on_view(void)
{
    return module.traits.degree > 0 || module.traits.mip;
}

/* Puts the bundle's Gaussians into the arena, as a camera sees them; NULL: as they are. Returns a t3r_status. */
static t3r_status append_gaussians(const seen_from *from)
{
    t3r_status status = t3r_scene_begin(module.runtime, &module.scene_frame);
    for (uint32_t i = 0; i < module.gaussian_count && status == T3R_OK; i++) {
        t3r_gaussian g = gaussian_at(i);
        if (from != NULL) { /* blocks are aligned to 16, and WebAssembly is little-endian */
            status =
                seen_gaussian(&module.traits, (const int16_t *)(module.harmonics + i * harmonics_bytes()), from, &g);
        }
        status = status == T3R_OK ? t3r_scene_append(module.runtime, &g) : status;
    }
    return status == T3R_OK ? t3r_get_scene(module.runtime, &module.scene) : status;
}

/* Puts the bundle's Gaussians into the arena. Returns a t3r_status. */
EXPORT(load) int32_t module_load(void)
{
    module.loaded = true;
    return append_gaussians(NULL);
}

/* Adds the context views to an empty arena. Returns a t3r_status. */
static t3r_status add_views(void)
{
    const uint32_t width = module.config.width, height = module.config.height;
    t3r_status status = t3r_reset(module.runtime);
    for (uint32_t v = 0; v < module.config.views && status == T3R_OK; v++) {
        const frame_data *f = &module.frame[v];
        const t3r_frame frame = {
            .format = T3R_PIXEL_RGB24,
            .width = width,
            .height = height,
            .planes = {f->rgb},
            .stride_bytes = {width * 3},
            .depth = f->depth,
            .depth_width = f->depth != NULL ? width : 0,
            .depth_height = f->depth != NULL ? height : 0,
            .depth_stride_bytes = f->depth != NULL ? width * 2 : 0,
            .depth_unit_q40 = f->depth_unit_q40,
        };
        status = t3r_add_view(module.runtime, &frame, &f->camera);
    }
    return status;
}

/* Builds a scene of this budget: the first time from the frames, then from the analysis that was kept. Returns a
 * t3r_status. */
EXPORT(build) int32_t module_build(uint32_t gaussians)
{
    const t3r_request request = {.gaussians = gaussians};
    module.loaded = false;
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        module.hashed[stage] = 0;
    }
    t3r_status status = t3r_set_hooks(module.runtime, &building);
    if (status == T3R_OK && module.runtime->analysed) {
        status = t3r_rebuild(module.runtime, &request, &module.scene);
    } else if (status == T3R_OK) {
        status = add_views();
        status = status == T3R_OK ? t3r_reconstruct(module.runtime, &request, &module.scene) : status;
    }
    (void)t3r_set_hooks(module.runtime, &drawing);
    return status;
}

/* A scene on its way from the module that built it to one that draws it. */
typedef struct carried {
    t3r_scene_frame frame;
    uint32_t count;
    uint32_t valid_points;
    t3r_gaussian gaussians[];
} carried;

/* Returns the bytes of a carried scene with this many Gaussians. */
EXPORT(carried_bytes) uint32_t module_carried_bytes(uint32_t count)
{
    return (uint32_t)(sizeof(carried) + count * sizeof(t3r_gaussian));
}

/* Writes the scene that was built to an address aligned to 64. */
EXPORT(give) void module_give(carried *out)
{
    out->frame = module.scene.frame;
    out->count = module.scene.count;
    out->valid_points = module.scene.valid_points;
    memcpy(out->gaussians, module.scene.gaussians, module.scene.count * sizeof *out->gaussians);
}

/* Puts a carried scene into the arena. Returns a t3r_status. */
EXPORT(take) int32_t module_take(const carried *in)
{
    module.loaded = false;
    t3r_status status = t3r_scene_begin(module.runtime, &in->frame);
    for (uint32_t i = 0; i < in->count && status == T3R_OK; i++) {
        status = t3r_scene_append(module.runtime, &in->gaussians[i]);
    }
    status = status == T3R_OK ? t3r_get_scene(module.runtime, &module.scene) : status;
    module.scene.valid_points = in->valid_points;
    return status;
}

EXPORT(gaussians) uint32_t module_gaussians(void)
{
    return module.scene.count;
}

EXPORT(valid_points) uint32_t module_valid_points(void)
{
    return module.scene.valid_points;
}

/* Returns the exponent of the scene's frame: the median depth is 1 to 2 times 2^exponent world units. */
EXPORT(exponent) int32_t module_exponent(void)
{
    return module.scene.frame.exponent;
}

/* Returns the hash of a stage of the last build, 0 = it did not run; for T3R_STAGE_COUNT the hash of all stages that
 * ran. */
EXPORT(hash) uint64_t module_hash(uint32_t stage)
{
    if (stage < T3R_STAGE_COUNT) {
        return module.hashed[stage] ? module.hash[stage] : 0;
    }
    uint64_t hash = T3R_HASH_START;
    for (uint32_t i = 0; i < T3R_STAGE_COUNT; i++) {
        if (module.hashed[i]) {
            hash = t3r_hash_u64(t3r_hash_u8(hash, (uint8_t)i), module.hash[i]);
        }
    }
    return hash;
}

/* ---- pictures ---------------------------------------------------------------------------------------------------- */

/* Draws RGB, depth (Q20 scene units) and alpha (Q15), rows without gaps, as a camera of these numbers sees the scene
 * (t3r_camera has their ranges). Returns a t3r_status. */
EXPORT(render)
int32_t module_render(int32_t fx_q16, int32_t fy_q16, int32_t cx_q16, int32_t cy_q16, int64_t x_q32, int64_t y_q32,
                      int64_t z_q32, int32_t qw_q30, int32_t qx_q30, int32_t qy_q30, int32_t qz_q30, uint32_t width,
                      uint32_t height, uint8_t *rgb, uint32_t *depth_q20, uint16_t *alpha_q15)
{
    const t3r_camera camera = {
        .fx_q16 = fx_q16,
        .fy_q16 = fy_q16,
        .cx_q16 = cx_q16,
        .cy_q16 = cy_q16,
        .position_q32 = {x_q32, y_q32, z_q32},
        .rotation_q30 = {qw_q30, qx_q30, qy_q30, qz_q30},
    };
    const t3r_target target = {
        .width = width,
        .height = height,
        .rgb = rgb,
        .rgb_stride_bytes = width * 3,
        .depth_q20 = depth_q20,
        .depth_stride_bytes = width * 4,
        .alpha_q15 = alpha_q15,
        .alpha_stride_bytes = width * 2,
    };
    seen_from from;
    if (module.loaded && depends_on_view() &&
        seen_from_camera(&camera, &module.scene_frame, width, height, &from) == T3R_OK) {
        const t3r_status status = append_gaussians(&from);
        if (status != T3R_OK) {
            return status;
        }
    }
    return t3r_render(module.runtime, &camera, &target);
}

/* Returns the hash of a picture's RGB, as `trim3r render --json` prints it. */
EXPORT(picture_hash) uint64_t module_picture_hash(const uint8_t *rgb, uint32_t width, uint32_t height)
{
    return t3r_hash_bytes(T3R_HASH_START, rgb, (size_t)width * height * 3);
}

/* Returns the pixels of a frame in the bundle, 3 bytes each. */
EXPORT(frame_rgb) const uint8_t *module_frame_rgb(uint32_t frame)
{
    return frame < module.frames ? module.frame[frame].rgb : NULL;
}

enum { PLANE_MASK, PLANE_TEXTURE };

/* Returns a plane of an analysed context view: the mask of retained pixels (a bit each, in words) or the texture (16
 * bits each). NULL = there is none. */
EXPORT(plane) const void *module_plane(uint32_t view, uint32_t plane)
{
    if (!module.runtime->analysed || view >= module.config.views) {
        return NULL;
    }
    const t3r_view planes = t3r_view_of(module.runtime, view);
    return plane == PLANE_MASK ? (const void *)planes.mask : planes.texture;
}

#define NO_LABEL UINT16_MAX

/* Writes the SuperCluster of each pixel of an analysed context view, NO_LABEL where there is no depth or no
 * analysis. */
EXPORT(labels) void module_labels(uint32_t view, uint16_t *label)
{
    const bool is_analysed = module.runtime->analysed && view < module.config.views;
    const t3r_view planes = t3r_view_of(module.runtime, is_analysed ? view : 0);
    for (size_t i = 0; i < (size_t)planes.width * planes.height; i++) {
        const bool has_label = is_analysed && t3r_has_depth(planes.validity[i]);
        label[i] = has_label ? (uint16_t)t3r_label_of(&planes, i) : NO_LABEL;
    }
}
