/* SPDX-License-Identifier: Apache-2.0 */
/* The runtime as a WebAssembly module, called by the page's worker. The worker places the bundle and the arena in the
 * module's memory, which the worker grows; the module has no heap. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/hash.h"
#include "module/bundle_read.h"
#include "module/carried.h"
#include "module/sketch.h"
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

/* The origin of the scene in the arena. */
typedef enum source_kind { SCENE_BUILT, SCENE_OF_BUNDLE, SCENE_TAKEN } source_kind;

/* The Gaussians that are drawn and written: those whose centres are in a box, and that are opaque enough. */
typedef struct kept_part {
    uint32_t opacity_least_q15;
    int32_t low_q20[3], high_q20[3];
} kept_part;

static const kept_part everything = {.low_q20 = {INT32_MIN, INT32_MIN, INT32_MIN},
                                     .high_q20 = {INT32_MAX, INT32_MAX, INT32_MAX}};

/* The module keeps one bundle: a page shows one scene. */
static struct {
    bundle_data bundle;
    t3r_runtime *runtime;
    struct {
        t3r_config config;
        t3r_runtime *runtime; /* NULL: there is no sketch of this scene */
        sketch sample;
        uint32_t drawn; /* Gaussians in the runtime */
    } sketched;
    source_kind source;
    const carried *taken; /* the whole scene, if it was taken */
    kept_part kept;
    t3r_scene scene; /* in the arena: the kept part */
    bool is_seen;    /* as a camera sees it */
    uint32_t pictured;
    uint64_t hash[T3R_STAGE_COUNT];
    uint8_t hashed[T3R_STAGE_COUNT];
} module;

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

/* Returns the bytes of an arena, rounded up to the next arena's alignment; 0 = the configuration is refused. */
static uint32_t arena_bytes(const t3r_config *config)
{
    t3r_plan_info plan;
    return t3r_plan(config, &plan) == T3R_OK
               ? ((uint32_t)plan.bytes + T3R_ARENA_ALIGN - 1) / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN
               : 0;
}

/* Opens the bundle at this address, aligned to 16, which must stay in the module's memory; targets are at most of this
 * size. builds: 1 = it builds scenes, 0 = it only draws, in smaller arenas. workers: threads that page_parallel_for()
 * has. Returns the bytes that module_start() needs; 0 = the bundle is damaged or its configuration refused. */
EXPORT(open)
uint32_t module_open(const uint8_t *bundle, uint32_t bytes, uint32_t render_width, uint32_t render_height,
                     uint32_t builds, uint32_t workers)
{
    t3r_config *config = &module.bundle.config, *less = &module.sketched.config;
    if (!bundle_read(bundle, bytes, &module.bundle)) {
        return 0;
    }
    if (builds == 0) {
        config->views = 0;
        module.bundle.weight_bytes = 0;
    }
    config->workers = workers;
    config->render_width = render_width;
    config->render_height = render_height;
    *less = *config;
    less->max_gaussians = config->views > 0 ? 0 : T3R_MIN(config->max_gaussians, SKETCH_MOST);
    const uint32_t whole = arena_bytes(config);
    const size_t sample = sketch_bytes(config->max_gaussians);
    return less->max_gaussians > 0 && whole > 0 ? whole + arena_bytes(less) + (uint32_t)sample : whole;
}

static t3r_status start_runtime(t3r_runtime **runtime, void *arena, size_t bytes, const t3r_config *config)
{
    t3r_status status = t3r_init(runtime, arena, bytes, config);
    status = status == T3R_OK ? t3r_set_cpu(*runtime, t3r_cpu_found()) : status;
    return status == T3R_OK ? t3r_set_hooks(*runtime, &drawing) : status;
}

/* Initialises the memory at this address, aligned to 64. Returns a t3r_status. */
EXPORT(start) int32_t module_start(uint8_t *memory)
{
    const t3r_config *config = &module.bundle.config, *less = &module.sketched.config;
    const uint32_t bytes = arena_bytes(config);
    t3r_status status = start_runtime(&module.runtime, memory, bytes, config);
    module.sketched.runtime = NULL;
    if (status == T3R_OK && less->max_gaussians > 0) {
        const uint32_t less_bytes = arena_bytes(less);
        status = start_runtime(&module.sketched.runtime, memory + bytes, less_bytes, less);
        sketch_init(&module.sketched.sample, memory + bytes + less_bytes, config->max_gaussians);
    }
    if (status == T3R_OK && module.bundle.weight_bytes > 0) {
        status = t3r_bind_head(module.runtime, module.bundle.weights, module.bundle.weight_bytes);
    }
    return status;
}

/* Returns the meaning of a t3r_status. */
EXPORT(error_text) const char *module_error_text(int32_t status)
{
    return t3r_error_text((t3r_status)status);
}

/* Returns the features that the inner loops use, T3R_CPU_... */
EXPORT(cpu) uint32_t module_cpu(void)
{
    return t3r_get_cpu(module.runtime);
}

/* ---- the kept part of a scene ------------------------------------------------------------------------------------ */

/* Returns the number of Gaussians of the whole scene. */
EXPORT(whole) uint32_t module_whole(void)
{
    return module.source == SCENE_TAKEN       ? module.taken->count
           : module.source == SCENE_OF_BUNDLE ? module.bundle.gaussian_count
                                              : module.scene.count;
}

/* Returns a Gaussian of the whole scene as it is, not as a camera sees it. */
static t3r_gaussian whole_gaussian(uint32_t index)
{
    return module.source == SCENE_TAKEN       ? module.taken->gaussians[index]
           : module.source == SCENE_OF_BUNDLE ? bundle_gaussian(&module.bundle, index)
                                              : module.scene.gaussians[index];
}

/* Returns a coordinate of a Gaussian of the whole scene, Q20 in scene units. */
EXPORT(position) int32_t module_position(uint32_t index, uint32_t axis)
{
    return whole_gaussian(index).position_q20[axis];
}

static bool is_kept(const t3r_gaussian *g)
{
    bool is_inside = true;
    for (int i = 0; i < 3; i++) {
        is_inside =
            is_inside && g->position_q20[i] >= module.kept.low_q20[i] && g->position_q20[i] <= module.kept.high_q20[i];
    }
    return is_inside && g->opacity_q15 >= module.kept.opacity_least_q15;
}

/* Returns the frame of the whole scene; that in the arena may be a view's own. */
static const t3r_scene_frame *frame_of_scene(void)
{
    return module.source == SCENE_TAKEN       ? &module.taken->frame
           : module.source == SCENE_OF_BUNDLE ? &module.bundle.scene_frame
                                              : &module.scene.frame;
}

static const seen_traits *traits_of_scene(void)
{
    static const seen_traits plain = {0};
    return module.source == SCENE_OF_BUNDLE ? &module.bundle.traits : &plain;
}

/* Puts a Gaussian of the whole scene into an arena, as a camera sees it; NULL: as it is. */
static t3r_status append(t3r_runtime *to, uint32_t index, const t3r_gaussian *gaussian, const seen_from *from)
{
    const bool is_bundle = module.source == SCENE_OF_BUNDLE;
    const double times = is_bundle ? bundle_times(&module.bundle, index) : 1;
    const int16_t *harmonics_q12 = is_bundle ? bundle_harmonics(&module.bundle, index) : NULL;
    t3r_gaussian g = *gaussian;
    const t3r_status status = from != NULL ? seen_gaussian(traits_of_scene(), times, harmonics_q12, from, &g) : T3R_OK;
    return status == T3R_OK ? t3r_scene_append(to, &g) : status;
}

/* Puts the kept Gaussians into the arena, as a camera sees them; NULL: as they are. Returns a t3r_status. */
static t3r_status append_kept(const seen_from *from)
{
    const uint32_t count = module_whole();
    t3r_status status = t3r_scene_begin(module.runtime, from != NULL ? &from->frame : frame_of_scene());
    module.is_seen = from != NULL;
    for (uint32_t i = 0; i < count && status == T3R_OK; i++) {
        const t3r_gaussian g = whole_gaussian(i);
        status = is_kept(&g) ? append(module.runtime, i, &g, from) : T3R_OK;
    }
    status = status == T3R_OK ? t3r_get_scene(module.runtime, &module.scene) : status;
    if (module.source == SCENE_TAKEN) {
        module.scene.valid_points = module.taken->valid_points;
    }
    return status;
}

/* Puts another part of a scene into the arena. Returns a t3r_status. */
static t3r_status keep_part(const kept_part *part)
{
    module.kept = *part;
    module.sketched.sample.count = 0;
    return append_kept(NULL);
}

/* Keeps the Gaussians of this opacity (Q15) and more whose centres are in this box (Q20 scene units, both ends in it),
 * of a scene that was loaded or taken. Returns a t3r_status. */
EXPORT(keep)
int32_t module_keep(uint32_t opacity_least_q15, int32_t low_x, int32_t low_y, int32_t low_z, int32_t high_x,
                    int32_t high_y, int32_t high_z)
{
    return keep_part(&(kept_part){opacity_least_q15, {low_x, low_y, low_z}, {high_x, high_y, high_z}});
}

/* Puts the bundle's Gaussians into the arena. Returns a t3r_status. */
EXPORT(load) int32_t module_load(void)
{
    module.source = SCENE_OF_BUNDLE;
    return keep_part(&everything);
}

/* Puts a carried scene into the arena, which stays where it is. Returns a t3r_status. */
EXPORT(take) int32_t module_take(const carried *in)
{
    module.source = SCENE_TAKEN;
    module.taken = in;
    return keep_part(&everything);
}

/* ---- the sketch -------------------------------------------------------------------------------------------------- */

/* Arranges the kept Gaussians for sketches, unless they are already. */
EXPORT(arrange) void module_arrange(void)
{
    sketch *sample = &module.sketched.sample;
    if (module.sketched.runtime == NULL || sample->count > 0) {
        return;
    }
    const uint32_t count = module_whole();
    sketch_begin(sample);
    for (uint32_t i = 0; i < count; i++) {
        const t3r_gaussian g = whole_gaussian(i);
        if (is_kept(&g)) {
            sketch_weigh(sample, i, &g);
        }
    }
    sketch_arrange(sample, &module.runtime->kernels);
    module.sketched.drawn = 0;
}

/* Puts the first Gaussians of the sample into its arena, as a camera sees them; NULL: as they are. Returns a
 * t3r_status. */
static t3r_status append_sketch(uint32_t drawn, const seen_from *from)
{
    const sketch *sample = &module.sketched.sample;
    if (from == NULL && module.sketched.drawn == drawn) {
        return T3R_OK;
    }
    t3r_status status = t3r_scene_begin(module.sketched.runtime, from != NULL ? &from->frame : frame_of_scene());
    for (uint32_t rank = 0; rank < drawn && status == T3R_OK; rank++) {
        const uint32_t index = sketch_index(sample, rank);
        t3r_gaussian g = whole_gaussian(index);
        sketch_widen(sample, drawn, &g);
        status = append(module.sketched.runtime, index, &g, from);
    }
    module.sketched.drawn = status == T3R_OK && from == NULL ? drawn : 0;
    return status;
}

/* ---- building ---------------------------------------------------------------------------------------------------- */

/* Adds the context views to an empty arena. Returns a t3r_status. */
static t3r_status add_views(void)
{
    const uint32_t width = module.bundle.config.width, height = module.bundle.config.height;
    t3r_status status = t3r_reset(module.runtime);
    for (uint32_t v = 0; v < module.bundle.config.views && status == T3R_OK; v++) {
        const frame_data *f = &module.bundle.frame[v];
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
    module.source = SCENE_BUILT;
    module.is_seen = false;
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

static uint32_t degree_of_scene(void)
{
    return module.source == SCENE_OF_BUNDLE ? module.bundle.traits.degree : 0;
}

/* Returns the bytes of the scene in the arena when it is carried. */
EXPORT(carried_bytes) uint32_t module_carried_bytes(void)
{
    const uint32_t numbers = carried_harmonics_count(degree_of_scene());
    return (uint32_t)(sizeof(carried) + module.scene.count * (sizeof(t3r_gaussian) + numbers * sizeof(int16_t)));
}

/* Writes the scene that was built, or the kept part of another one, to an address aligned to 64. */
EXPORT(give) void module_give(carried *out)
{
    const uint32_t numbers = carried_harmonics_count(degree_of_scene()), whole = module_whole();
    *out = (carried){.frame = *frame_of_scene(),
                     .count = module.scene.count,
                     .valid_points = module.scene.valid_points,
                     .degree = degree_of_scene(),
                     .mip = module.source == SCENE_OF_BUNDLE && module.bundle.traits.mip};
    t3r_gaussian *gaussians = out->gaussians;
    int16_t *harmonics = carried_harmonics(out);
    for (uint32_t i = 0; i < whole; i++) {
        const t3r_gaussian g = whole_gaussian(i);
        if (module.source != SCENE_BUILT && !is_kept(&g)) {
            continue;
        }
        *gaussians++ = g;
        for (uint32_t k = 0; k < numbers; k++) {
            *harmonics++ = bundle_harmonics(&module.bundle, i)[k];
        }
    }
}

EXPORT(gaussians) uint32_t module_gaussians(void)
{
    return module.scene.count;
}

EXPORT(valid_points) uint32_t module_valid_points(void)
{
    return module.scene.valid_points;
}

/* Returns a coordinate of the scene's origin in the world, Q32. */
EXPORT(origin) int64_t module_origin(uint32_t axis)
{
    return frame_of_scene()->origin_q32[axis];
}

/* Returns the exponent of the scene's frame: the median depth is 1 to 2 times 2^exponent world units. */
EXPORT(exponent) int32_t module_exponent(void)
{
    return frame_of_scene()->exponent;
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

/* Turns depths in the frame of a view to those in the scene's. */
static void expand_depths(const seen_from *from, uint32_t *depth_q20, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const double depth = seen_depth(from, depth_q20[i]) / from->view.ratio * 0x1p20;
        depth_q20[i] = depth < UINT32_MAX ? (uint32_t)depth : UINT32_MAX;
    }
}

/* Draws RGB, depth (Q20 scene units) and alpha (Q15), rows without gaps, as a camera of these numbers sees the scene
 * (t3r_camera has their ranges); NULL leaves a plane out. most: a sketch of at most so many Gaussians is drawn, if the
 * scene has more and is arranged; 0 = the whole scene. Returns a t3r_status. */
EXPORT(render)
int32_t module_render(int32_t fx_q16, int32_t fy_q16, int32_t cx_q16, int32_t cy_q16, int64_t x_q32, int64_t y_q32,
                      int64_t z_q32, int32_t qw_q30, int32_t qx_q30, int32_t qy_q30, int32_t qz_q30, uint32_t width,
                      uint32_t height, uint8_t *rgb, uint32_t *depth_q20, uint16_t *alpha_q15, uint32_t most)
{
    const uint32_t drawn = T3R_MIN(most, module.sketched.config.max_gaussians);
    const bool is_sketched = drawn > 0 && drawn < module.sketched.sample.count;
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
    seen_from_camera(&camera, frame_of_scene(), traits_of_scene(), width, height, &from);
    const bool differs = module.source != SCENE_BUILT && seen_differs(traits_of_scene(), &from);
    const seen_from *seen = differs ? &from : NULL;
    t3r_status status = is_sketched                 ? append_sketch(drawn, seen)
                        : differs || module.is_seen ? append_kept(seen)
                                                    : T3R_OK;
    module.pictured = is_sketched ? drawn : module.scene.count;
    status = status == T3R_OK ? t3r_render(is_sketched ? module.sketched.runtime : module.runtime, &camera, &target)
                              : status;
    if (status == T3R_OK && differs && from.is_own && depth_q20 != NULL) {
        expand_depths(&from, depth_q20, (size_t)width * height);
    }
    return status;
}

/* Returns the Gaussians of the last picture. */
EXPORT(pictured) uint32_t module_pictured(void)
{
    return module.pictured;
}

/* Returns the hash of a picture's RGB, as `trim3r render --json` prints it. */
EXPORT(picture_hash) uint64_t module_picture_hash(const uint8_t *rgb, uint32_t width, uint32_t height)
{
    return t3r_hash_bytes(T3R_HASH_START, rgb, (size_t)width * height * 3);
}

/* Returns the pixels of a frame in the bundle, 3 bytes each. */
EXPORT(frame_rgb) const uint8_t *module_frame_rgb(uint32_t frame)
{
    return frame < module.bundle.frames ? module.bundle.frame[frame].rgb : NULL;
}

/* Returns the pixels of a frame that its recorded picture reaches: a byte each, 0 = beyond the lens; NULL = all. */
EXPORT(frame_shown) const uint8_t *module_frame_shown(uint32_t frame)
{
    return frame < module.bundle.frames ? module.bundle.frame[frame].shown : NULL;
}

enum { PLANE_MASK, PLANE_TEXTURE };

/* Returns a plane of an analysed context view: the mask of retained pixels (a bit each, in words) or the texture (16
 * bits each). NULL = there is none. */
EXPORT(plane) const void *module_plane(uint32_t view, uint32_t plane)
{
    if (!module.runtime->analysed || view >= module.bundle.config.views) {
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
    const bool is_analysed = module.runtime->analysed && view < module.bundle.config.views;
    const t3r_view planes = t3r_view_of(module.runtime, is_analysed ? view : 0);
    for (size_t i = 0; i < (size_t)planes.width * planes.height; i++) {
        const bool has_label = is_analysed && t3r_has_depth(planes.validity[i]);
        label[i] = has_label ? (uint16_t)t3r_label_of(&planes, i) : NO_LABEL;
    }
}
