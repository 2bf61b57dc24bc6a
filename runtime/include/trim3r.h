/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r turns a few posed camera frames into a budgeted set of 3-D Gaussians and draws views of it, in integers.
 *
 * This is the whole interface of the runtime. It has no heap, no floating point, no operating system and no writable
 * globals: the caller supplies one arena, which holds everything. The same frames, settings and weights give the
 * same bits on every processor. The life of a runtime:
 *
 *     t3r_plan()      how many bytes             t3r_attach()   an arena that was copied, as it was left
 *         |
 *     t3r_init() --> empty -- t3r_add_view() --> views -- t3r_reconstruct() --> scene -- t3r_render() --> scene alone
 *                      ^                         |   ^                          | ^ |                     |   ^ |
 *                      |                         +---+ t3r_add_view()           | +-+ t3r_reconstruct()   |   +-+
 *                      +--------------------------- t3r_reset() ----------------+-------------------------+
 *
 *     a stream:      empty -- t3r_stream_keyframe() --> scene, and once more for each further keyframe
 *     from a file:   any -- t3r_scene_begin() --> scene alone, and t3r_scene_append() for each Gaussian
 *
 * A scene has its views until t3r_render() draws in their memory. With keep_analysis, t3r_render() keeps the views, and
 * t3r_rebuild() makes further scenes of them. With `warm` it keeps them, too, and t3r_add_view() may follow a scene. A
 * call that does not fit the state returns T3R_ERR_STATE and changes nothing. docs/firmware.md has a table of what each
 * call does in each state.
 *
 * Threads: calls on one runtime take turns, in any threads. Those that take a const t3r_runtime may overlap each other.
 * Different runtimes, and calls without a runtime, are independent. No call is allowed on a runtime from its own hooks,
 * or from an interrupt during another call on it.
 *
 * Memory: the arena may be copied, moved and saved between calls, and a copy is bound by t3r_attach(). The pointers to
 * the runtime and to the scene's Gaussians are into the arena. The weights of a head stay where they are while bound.
 * Everything else that a call takes is read during that call only; of hooks a copy is kept.
 *
 * The shortest program follows. Calls return a t3r_status, which a real program checks:
 *
 *     static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[T3R_ARENA_BYTES(256, 256, 2, 13107)];
 *     t3r_config config = t3r_default_config(256, 256, 2, 13107);
 *     t3r_init(&rt, arena, sizeof arena, &config);
 *     t3r_add_view(rt, &frames[0], &cameras[0]);
 *     t3r_add_view(rt, &frames[1], &cameras[1]);
 *     t3r_reconstruct(rt, NULL, &scene);
 *     t3r_render(rt, &eye, &target);
 *
 * Conventions: pixel (0, 0) is the centre of the top-left pixel. Cameras look along +z, with x to the right and y down.
 * Poses are camera-to-world. "World units" are those of the poses and of the depth (metres where the source has
 * metres); "scene units" are world units times a power of two (t3r_scene_frame). Names of fields carry their
 * fixed-point format: depth_q20 has 20 fraction bits. Each rounding is written down in runtime/SPEC.md.
 *
 * Copyright 2026 the trim3r developers. Licensed under the Apache License, Version 2.0. */
#ifndef TRIM3R_H
#define TRIM3R_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r_arena.h"
#include "trim3r_features.h"
#include "trim3r_interface.h"
#include "trim3r_settings.h"

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default) /* what a shared library exports */
#endif

/* Version of this header; t3r_version() returns the library's. */
#define T3R_VERSION_MAJOR 0
#define T3R_VERSION_MINOR 2
#define T3R_VERSION_PATCH 0
#define T3R_VERSION T3R_TEXT_(T3R_VERSION_MAJOR) "." T3R_TEXT_(T3R_VERSION_MINOR) "." T3R_TEXT_(T3R_VERSION_PATCH)
#define T3R_TEXT_(number) T3R_QUOTE_(number)
#define T3R_QUOTE_(number) #number
/* Raised by every change of any output bit; recordings and scenes carry the epoch that made them. */
#define T3R_BITS_EPOCH 19

#define T3R_MAX_SIDE 4096         /* largest width or height of working size, frame or target, in pixels */
#define T3R_MIN_SIDE 8            /* smallest working width or height, in pixels */
#define T3R_STEREO_LEAST_SIDE 32u /* smallest working width or height with depth by stereo, in pixels */
#define T3R_MAX_VIEWS 16          /* most context views */
#define T3R_NO_VIEW 255           /* t3r_gaussian.view of rim and backdrop */
#define T3R_MAX_REMEMBERED 16     /* most keyframes that a stream remembers without planes */
#define T3R_MAX_CLUSTERS 512      /* most SuperClusters */
#define T3R_MAX_GAUSSIANS 16777216
#define T3R_HARMONICS_DEGREE_MOST 3u
#define T3R_HARMONICS_MOST 16u /* of each colour, degree 0 included */
#define T3R_MAX_REFINE 32
#define T3R_STREAM_REFINE 4u /* most passes for a keyframe whose number of passes is fitted */
#define T3R_MAX_LEVELS 5     /* most wavelet levels */
#define T3R_MAX_HEAD_COLUMN_BYTES 65536
#define T3R_MAX_LOSS_Q8 2560u  /* 10 dB */
#define T3R_MAX_PSNR_Q8 25600u /* 100 dB, also where nothing differs */
#define T3R_MAX_WORKERS 16

/* Enumerations have 32 bits, here and below, because the width of an enum type depends on the compiler and its
 * options. */
typedef int32_t t3r_status;
enum {
    T3R_OK = 0,
    T3R_ERR_ARGUMENT = -1,  /* a null pointer or a number outside its documented range */
    T3R_ERR_CONFIG = -2,    /* a t3r_config field outside its documented range */
    T3R_ERR_ARENA = -3,     /* the arena is smaller than t3r_plan() asks, or misaligned */
    T3R_ERR_FRAME = -4,     /* a frame whose format, size or stride cannot be read */
    T3R_ERR_CAMERA = -5,    /* a camera for another size, or with intrinsics, distortion or pose outside their range */
    T3R_ERR_STATE = -6,     /* calls out of order: no views yet, too many views, no analysis kept */
    T3R_ERR_NO_DEPTH = -7,  /* a context view without a single valid depth */
    T3R_ERR_CANCELLED = -8, /* the progress callback asked to stop */
    T3R_ERR_EPOCH = -9,     /* a copied arena made by another version, layout or bits epoch */
    T3R_ERR_FULL = -10,     /* no room for another Gaussian in the scene */
    T3R_ERR_WEIGHTS = -11,  /* weights: foreign, damaged, of another epoch, or of too large a head for the arena */
    T3R_ERR_STEREO = -12,   /* no depth can be made of the views: t3r_stereo_pair() has the reason */
    T3R_ERR_UNSUPPORTED = -13, /* the library was built without a requested feature: t3r_features() */
    T3R_ERR_INTERFACE = -14    /* the program was compiled with another trim3r.h, other features or another layout of
                                * structs than the library */
};

/* The stages in the order in which the data passes them. */
typedef uint32_t t3r_stage;
enum {
    T3R_STAGE_IMAGE = T3R_AT_IMAGE,
    T3R_STAGE_DEPTH = T3R_AT_DEPTH,
    T3R_STAGE_POINTMAP = T3R_AT_POINTMAP,
    T3R_STAGE_WAVELET = T3R_AT_WAVELET,
    T3R_STAGE_SUPERCLUSTERS = T3R_AT_SUPERCLUSTERS,
    T3R_STAGE_BUDGET = T3R_AT_BUDGET,
    T3R_STAGE_HEAD = T3R_AT_HEAD,
    T3R_STAGE_REFINE = T3R_AT_REFINE,
    T3R_STAGE_RASTER = T3R_AT_RASTER,
    T3R_STAGE_COUNT = T3R_AT_COUNT
};

typedef uint32_t t3r_pixel_format;
enum {
    T3R_PIXEL_RGB24, /* 3 bytes a pixel: R G B */
    T3R_PIXEL_BGR24, /* 3 bytes a pixel: B G R */
    T3R_PIXEL_GREY,  /* 1 byte a pixel */
    T3R_PIXEL_YUYV,  /* 4:2:2, Y0 U Y1 V; even width; BT.601 limited range */
    T3R_PIXEL_UYVY,  /* 4:2:2, U Y0 V Y1; even width; BT.601 limited range */
    T3R_PIXEL_NV12,  /* 4:2:0, a Y plane and an interleaved UV plane; even width and height; BT.601 limited range */
    T3R_PIXEL_FORMAT_COUNT
};

/* One captured frame. Its memory belongs to the caller and is read only during the call that takes the frame. */
typedef struct t3r_frame {
    /* The format of the colour planes. */
    t3r_pixel_format format;
    /* The size of the colour image in pixels, 2..T3R_MAX_SIDE each. */
    uint32_t width, height;
    /* The colour planes. planes[1] is read only with T3R_PIXEL_NV12. */
    const uint8_t *planes[2];
    /* The bytes from row to row of each plane, at least those of a row and below 2^19. */
    uint32_t stride_bytes[2];
    /* The depth along z in steps, 16 bits each, little-endian, registered to the colour image; 0 = not measured. NULL =
     * the frame has no depth. */
    const uint8_t *depth;
    /* The size of the depth image in pixels, 2..T3R_MAX_SIDE each. It may differ from that of the colour image. */
    uint32_t depth_width, depth_height;
    /* The bytes from row to row of the depth image, at least 2 x depth_width. */
    uint32_t depth_stride_bytes;
    /* The length of one step of depth in world units, 1..2^47 - 1, in 1/2^40. A millimetre in metres is 1099511628. */
    uint64_t depth_unit_q40;
} t3r_frame;

typedef uint32_t t3r_distortion;
enum {
    T3R_DISTORTION_NONE,
    T3R_DISTORTION_RADTAN,  /* k1 k2 p1 p2 k3 (Brown-Conrady; OpenCV "plumb_bob") */
    T3R_DISTORTION_FISHEYE, /* k1 k2 k3 k4 (Kannala-Brandt; OpenCV "equidistant") */
    T3R_DISTORTION_COUNT
};

/* A calibrated, posed pinhole camera. */
typedef struct t3r_camera {
    /* The size in pixels of the picture that the intrinsics are for; a frame or target of another size is refused.
     * 0 x 0 = the size of whichever frame or target the camera comes with. */
    uint32_t width, height;
    /* The focal lengths in pixels, from 8 up to, but not including, 16384. */
    int32_t fx_q16, fy_q16;
    /* The principal point in pixels, between -16384 and 16384. (0, 0) is the centre of the top-left pixel. */
    int32_t cx_q16, cy_q16;
    /* The model of the lens. */
    t3r_distortion distortion;
    /* The coefficients of that model, in its order; p1 and p2 are between -16 and 16. The others are ignored. */
    int32_t distortion_q24[5];
    /* The camera's centre in world units, each coordinate between -2^62 and 2^62 (in 1/2^32 units). */
    int64_t position_q32[3];
    /* The rotation from camera to world, a quaternion w x y z. Its norm is in [0.5, 1.5] and is normalised. */
    int32_t rotation_q30[4];
} t3r_camera;

typedef uint32_t t3r_wavelet;
#define T3R_WAVELET_ROW_(NAME, name) T3R_WAVELET_##NAME,
enum { T3R_WAVELETS(T3R_WAVELET_ROW_) T3R_WAVELET_COUNT };

/* The allocation of the budget Z over the valid points (runtime/SPEC.md, "Budget"): T3R_ALLOCATIONS. */
typedef uint32_t t3r_allocation;
#define T3R_ALLOCATE_ROW_(NAME, name) T3R_ALLOCATE_##NAME,
enum {
    T3R_ALLOCATE_CONFIGURED, /* in a request: the configuration's; in a configuration: refused */
    T3R_ALLOCATIONS(T3R_ALLOCATE_ROW_) T3R_ALLOCATE_COUNT
};

typedef uint32_t t3r_head;
enum {
    T3R_HEAD_CONFIGURED, /* in a request: the configuration's; in a configuration: refused */
    T3R_HEAD_ANALYTIC,   /* a disc on the surface, as wide as the spacing of its retained neighbours */
    T3R_HEAD_LEARNED,    /* a network that reads image, mask and density: t3r_bind_head() */
    T3R_HEAD_COUNT
};

/* The source of depth: T3R_DEPTHS. */
typedef uint32_t t3r_depth;
#define T3R_DEPTH_ROW_(NAME, name) T3R_DEPTH_##NAME,
enum { T3R_DEPTHS(T3R_DEPTH_ROW_) T3R_DEPTH_COUNT };

/* Whether two views can be matched, and why not. */
typedef uint32_t t3r_pair;
enum {
    T3R_PAIR_OK,
    T3R_PAIR_NO_BASELINE, /* both cameras have the same position and direction */
    T3R_PAIR_ROTATION,    /* both cameras have the same position, but different directions */
    T3R_PAIR_OVERLAP,     /* too little is visible in both pictures */
    T3R_PAIR_PARALLAX,    /* the visible surface hardly moves between both pictures */
    T3R_PAIR_SCALE,       /* the baseline in world units leaves no depth unit */
    T3R_PAIR_COUNT
};

/* The reason why a stream did not take a frame. */
typedef uint32_t t3r_refusal;
enum {
    T3R_REFUSAL_NONE,
    T3R_REFUSAL_NO_DEPTH,    /* fewer than 1/64 of the pixels have a measured depth */
    T3R_REFUSAL_FAR,         /* the camera is more than 1,024 scene units from the origin */
    T3R_REFUSAL_DARK,        /* more than 15/16 of the pixels are below level 16 */
    T3R_REFUSAL_BRIGHT,      /* more than 15/16 of the pixels are above level 239 */
    T3R_REFUSAL_EXPOSURE,    /* the frame is more than twice as bright as the map, or less than half as bright */
    T3R_REFUSAL_BLURRED,     /* the frame has less than 3/8 of the detail of the last keyframes */
    T3R_REFUSAL_COVERED,     /* something hides most of what the last keyframe saw, such as a hand on the lens */
    T3R_REFUSAL_CONTRADICTS, /* the depths or colours are not those of the map from there: the pose is wrong */
    T3R_REFUSAL_COUNT
};

/* Amounts of work for a build: t3r_set_preset(). */
typedef uint32_t t3r_preset;
enum {
    T3R_PRESET_FAST,     /* little work, for new views that may be less sharp */
    T3R_PRESET_BALANCED, /* most of the quality for a part of the work */
    T3R_PRESET_BEST,     /* the best new views, for any amount of work */
    T3R_PRESET_COUNT
};

/* Settings. t3r_default_config() fills every field; change what you need before t3r_init(). They hold for the life of
 * the runtime: no later call changes them. trim3r_settings.h has the fields, with their ranges and defaults. */
#define T3R_SETTING_(name, ...) uint32_t name;
typedef struct t3r_config {
    T3R_SETTINGS(T3R_SETTING_)
} t3r_config;

/* The request for one build. A field that is 0 leaves the configuration's value, so {0} is the same as NULL. A request
 * applies to its call only: the next one begins from the configuration again. */
typedef struct t3r_request {
    /* The budget of this scene, 1..max_gaussians; 0 = the configuration's. */
    uint32_t gaussians;
    /* The most that the scene may lose against one of all points, in 1/256 dB of PSNR, 1..T3R_MAX_LOSS_Q8. The build
     * makes the fewest Gaussians predicted to stay below it, and at most the budget. 0 = the budget is used up. */
    uint32_t max_loss_q8;
    /* The allocation of the budget. T3R_ALLOCATE_CONFIGURED (0) = the configuration's, or T3R_ALLOCATE_GIVEN with an
     * importance. No other allocation takes an importance. */
    t3r_allocation allocate;
    /* The head. T3R_HEAD_CONFIGURED (0) = the configuration's. */
    t3r_head head;
    /* The importance of each pixel, 0..65535. importance[v] is a plane of the working size for context view v, aligned
     * for its type and read during the call only. NULL = none. */
    const uint16_t *const *importance;
    /* The bytes from row to row of every importance plane, even and at least 2 x width. Ignored without planes. */
    uint32_t importance_stride_bytes;
} t3r_request;

/* The result of t3r_rebuild_least(). */
typedef struct t3r_least {
    /* The PSNR of the context view that the scene draws worst, in 1/256 dB, 0..T3R_MAX_PSNR_Q8. */
    uint32_t psnr_q8;
    /* The number of scenes that were built. */
    uint32_t builds;
} t3r_least;

/* The scene's fixed-point frame in the world: world = origin + scene x 2^exponent. */
typedef struct t3r_scene_frame {
    /* The origin in world units: the first context camera's centre; with `warm`, of the last build from scratch. */
    int64_t origin_q32[3];
    /* The exponent of the scene unit, -24..24, with which the median depth is in [1, 2) scene units. */
    int32_t exponent;
} t3r_scene_frame;

/* One Gaussian. Its covariance is F F^T with F = factor x 2^factor_exponent, row-major 3x3, in scene units: positive
 * semi-definite by construction, and precise over the whole dynamic range. */
typedef struct t3r_gaussian {
    /* The mean in scene units, each coordinate -2^30..2^30 (in 1/2^20 units). */
    int32_t position_q20[3];
    /* The mantissas of F. */
    int16_t factor[9];
    /* The exponent of F, -60..15. */
    int8_t factor_exponent;
    /* The index of its context view; in a stream, its keyframe's number modulo `views`; T3R_NO_VIEW = it belongs to the
     * rim or the backdrop, and has no depth. */
    uint8_t view;
    /* The colour r g b in 8-bit levels, 0..32640, in 1/128. */
    uint16_t colour_q7[3];
    /* The opacity at the mean, 0..32767, in 1/2^15. */
    uint16_t opacity_q15;
    /* The confidence of its depth: 255 = measured, less = filled or doubtful. */
    uint8_t confidence;
    /* Unused, 0. */
    uint8_t reserved[3];
} t3r_gaussian;

/* The scene in the arena, valid until the next call that builds or edits it. */
typedef struct t3r_scene {
    /* The frame of its Gaussians. */
    t3r_scene_frame frame;
    /* The Gaussians, in the arena. */
    const t3r_gaussian *gaussians;
    /* The number of Gaussians, 0..max_gaussians. */
    uint32_t count;
    /* The number of valid points: pixels of the context views with a measured or matched depth, holes not counted. 0 =
     * the scene came from a stream or from a file. */
    uint32_t valid_points;
} t3r_scene;

/* The memory that a render writes. Any of the three pictures may be NULL, which omits it. The background is black;
 * t3r_composite_row() draws another one.
 *
 * The camera of t3r_render() chooses the part and the scale. For a picture of w x h pixels that shows what another one
 * of W x H shows: fx' = fx w / W and cx' = (cx + 1/2) w / W - 1/2, and the same along y with h / H. For the part of a
 * picture that begins at pixel (x, y): cx' = cx - x and cy' = cy - y. Its width and height are the target's. */
typedef struct t3r_target {
    /* The size in pixels, 1..render_width and 1..render_height. */
    uint32_t width, height;
    /* The colour picture, R G B, 3 bytes a pixel. */
    uint8_t *rgb;
    /* The bytes from row to row of the colour picture, at least 3 x width. */
    uint32_t rgb_stride_bytes;
    /* The depth along z in scene units, at this pixel, of the splat at which transmittance falls below 1/2; 0 = there
     * is none. */
    uint32_t *depth_q20;
    /* The bytes from row to row of the depth picture, a multiple of 4 and at least 4 x width. */
    uint32_t depth_stride_bytes;
    /* The alpha, which is 1 - transmittance, 0..32767, in 1/2^15. */
    uint16_t *alpha_q15;
    /* The bytes from row to row of the alpha picture, a multiple of 2 and at least 2 x width. */
    uint32_t alpha_stride_bytes;
} t3r_target;

/* Optional callbacks, bound again after t3r_attach(). NULL = not called. */
typedef struct t3r_hooks {
    /* The caller's own, passed to each callback. */
    void *user;
    /* Called between bounded pieces of long work: a view, a row of a head, a batch, 8 first centres of SuperClusters,
     * 64 tiles, 65,536 splats blended into tiles. In refinement a piece is 256 splats blended into tiles. With several
     * workers it is 256 tiles, and for a head the views that they share. A return value other than 0 cancels the work.
     */
    int (*progress)(void *user, t3r_stage stage, uint32_t done, uint32_t total);
    /* Called with the hash of every stage of t3r_reconstruct(), t3r_rebuild() and t3r_render() (SPEC, "Hash"). */
    void (*stage_hash)(void *user, t3r_stage stage, uint64_t hash);
    /* Runs task(context, index, worker) for each index in 0..count-1, in any order, on any threads, and returns when
     * all are done. `worker` is a thread's number below t3r_config.workers: no two tasks that run at the same time
     * have the same one. The runtime never calls the hook from within a task. */
    void (*parallel_for)(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                         void *context);
} t3r_hooks;

/* One buffer of the arena. */
typedef struct t3r_plan_buffer {
    /* Its name in tables. */
    const char *name;
    /* Its place and size in an arena of t3r_plan_info.bytes, in bytes. */
    size_t offset, bytes;
    /* The first and the last stage that use it. */
    t3r_stage first, last;
} t3r_plan_buffer;

/* The size of an arena. */
typedef struct t3r_plan_info {
    /* The least bytes of an arena: one byte less is refused. */
    size_t min_bytes;
    /* The bytes with which a view takes one pass, unless most of its splats are many tiles wide. */
    size_t bytes;
    /* The most splats that one render of the largest target blends into tiles: every Gaussian in every tile, or
     * tile_splats in each. A scene of surfaces blends a few times max_gaussians. */
    uint64_t most_blends;
    /* The number of buffers, T3R_BUFFER_COUNT. */
    uint32_t buffer_count;
    /* The buffers, as laid out in an arena of `bytes`. */
    t3r_plan_buffer buffers[T3R_BUFFER_COUNT];
} t3r_plan_info;

/* The changes of a stream's map by one keyframe, and the figures by which the gate decides. */
typedef struct t3r_stream_report {
    /* The number of keyframes so far, including this one. */
    uint32_t keyframes;
    /* The number of Gaussians in the map, at most the configuration's. */
    uint32_t gaussians;
    /* The number of Gaussians that the keyframe added. */
    uint32_t added;
    /* The number of earlier Gaussians that the keyframe contradicts, or replaces because it sees them far finer. */
    uint32_t removed;
    /* The number of earlier Gaussians discarded for lack of room. */
    uint32_t crowded;
    /* The number of the keyframe's pixels with a depth, including filled ones. */
    uint32_t points;
    /* The number of these that the map already showed. */
    uint32_t shown;
    /* The reason why the frame was not taken: the map is unchanged, and all numbers above are 0, except keyframes and
     * gaussians. T3R_REFUSAL_NONE = the frame is a keyframe. */
    t3r_refusal refusal;
    /* 1 = a new piece of the map begins with this keyframe, because it and the frames refused before it contradict the
     * map; else 0. */
    uint32_t moved;
    /* 1 = poses jumped before this keyframe, and the map with all keyframes has moved as far; else 0. */
    uint32_t realigned;
    /* The share of the pixels that have a measured depth, and of those below level 16 and above level 239, 0..256, in
     * 1/256. */
    uint32_t depth_q8, dark_q8, bright_q8;
    /* The fine differences of the picture over its coarse ones, 0..1024, in 1/256: low where it is blurred. */
    uint32_t detail_q8;
    /* The number of compared Gaussians: those that the frame shows, and those that it sees through; at most 4,096. */
    uint32_t compared;
    /* The share of these that it sees through, 0..256, in 1/256. */
    uint32_t contradicted_q8;
    /* The correlation of the others' colours with the frame's, 0..256, in 1/256; 256 where the map has no contrast. */
    uint32_t likeness_q8;
    /* The number of Gaussians in the picture that the last keyframe saw, at most 4,096. */
    uint32_t recent;
    /* The share of all Gaussians that the last keyframe saw, 0..256, in 1/256. */
    uint32_t in_view_q8;
    /* The share of these that are behind something less than a quarter as far, or without a depth, 0..256, in 1/256. */
    uint32_t hidden_q8;
    /* The correlation of the hidden ones' colours with the frame's where it has no depth, as likeness_q8. */
    uint32_t hidden_likeness_q8;
    /* The level of the frame's green over the map's, log2 in 1/256, -1024..1020. */
    int32_t exposure_q8;
} t3r_stream_report;

typedef struct t3r_runtime t3r_runtime;

/* Returns a digest of this header's structs, as the program's compiler lays them out, and of its features, which invert
 * the lowest bits: T3R_HAS_... . t3r_interface() returns the library's own.
 *
 * A program starts with one of the inline calls below. Each passes the program's digest to the call of the same name
 * with the suffix _as. If the digest differs from the library's, that call touches nothing and returns
 * T3R_ERR_INTERFACE. A language that cannot use this header calls the _as calls itself, with the digest from
 * t3r_interface(). */
static inline uint64_t t3r_header_interface(void)
{
    uint64_t digest = 0;
    T3R_INTERFACE_TYPES_(T3R_DIGEST_TYPE_)
    T3R_INTERFACE_FIELDS_(T3R_DIGEST_FIELD_)
    T3R_SETTINGS(T3R_DIGEST_SETTING_)
    return digest ^ T3R_FEATURES_BUILT;
}
uint64_t t3r_interface(void);

/* Returns defaults for a working size, number of views and budget. If the digest or the number of bytes differs from
 * the library's, all fields are 0, which every other call refuses. */
t3r_status t3r_default_config_as(uint64_t digest, void *config, size_t config_bytes, uint32_t width, uint32_t height,
                                 uint32_t views, uint32_t gaussians);
static inline t3r_config t3r_default_config(uint32_t width, uint32_t height, uint32_t views, uint32_t gaussians)
{
    t3r_config config;
    (void)t3r_default_config_as(t3r_header_interface(), &config, sizeof config, width, height, views, gaussians);
    return config;
}

/* Returns the number of SuperClusters for the configuration: 1 for a stream. If `clusters` is 0, its allocation
 * decides: 300 for T3R_ALLOCATE_PAPER (GaussianTrim3R, section 4) and T3R_ALLOCATE_GIVEN, T3R_CLUSTERS_OF_POINTS of
 * all views' pixels for T3R_ALLOCATE_DENSITY, and 1 for the others, which use no SuperClusters. A request's own
 * allocation uses the same number. 0 without a configuration. */
uint32_t t3r_cluster_count(const t3r_config *config);

/* Returns the number of mini-batches of the K-means. If `cluster_batches` is 0, one for 8 SuperClusters, 1..24. 0
 * without a configuration. */
uint32_t t3r_cluster_batch_count(const t3r_config *config);

/* Computes the arena of this configuration. After T3R_ERR_CONFIG t3r_config_error() names the field.
 * T3R_ERR_UNSUPPORTED: the configuration is in range, but this library was built without a feature that it needs.
 * T3R_ERR_INTERFACE. */
t3r_status t3r_plan_as(uint64_t digest, const t3r_config *config, t3r_plan_info *plan);
static inline t3r_status t3r_plan(const t3r_config *config, t3r_plan_info *plan)
{
    return t3r_plan_as(t3r_header_interface(), config, plan);
}

/* Computes only the two sums of t3r_plan(), so that a firmware that sizes its arena at run time links no names of
 * buffers. Returns the errors of t3r_plan(). */
t3r_status t3r_plan_bytes_as(uint64_t digest, const t3r_config *config, size_t *min_bytes, size_t *bytes);
static inline t3r_status t3r_plan_bytes(const t3r_config *config, size_t *min_bytes, size_t *bytes)
{
    return t3r_plan_bytes_as(t3r_header_interface(), config, min_bytes, bytes);
}

/* Inverts t3r_plan(): lowers config->max_gaussians to the most with which t3r_init() accepts an arena of `bytes`, and
 * the budget `gaussians` along with it. It never raises them: begin with the most that you could use, width x height x
 * views. Takes 24 plans. T3R_ERR_ARENA: not even one Gaussian fits. T3R_ERR_CONFIG, T3R_ERR_UNSUPPORTED: see
 * t3r_plan(). After an error the configuration is unchanged. */
t3r_status t3r_plan_within_as(uint64_t digest, size_t bytes, t3r_config *config);
static inline t3r_status t3r_plan_within(size_t bytes, t3r_config *config)
{
    return t3r_plan_within_as(t3r_header_interface(), bytes, config);
}

/* Sets the best head, refine, fit_passes and structural for an amount of work, at any size and budget; the other fields
 * of `config` are kept. The settings were chosen on training scenes (docs/budgets.md, "How much work"). *weights gets
 * the name of the head's weights in quant/heads, for t3r_bind_head(); `weights` may be NULL.
 *
 * T3R_ERR_ARGUMENT: config is NULL, or preset is out of range. T3R_ERR_UNSUPPORTED: this library was built without a
 * feature that the row needs. T3R_ERR_INTERFACE. After an error both are unchanged. */
t3r_status t3r_set_preset_as(uint64_t digest, t3r_preset preset, t3r_config *config, const char **weights);
static inline t3r_status t3r_set_preset(t3r_preset preset, t3r_config *config, const char **weights)
{
    return t3r_set_preset_as(t3r_header_interface(), preset, config, weights);
}

/* Returns the first field of the configuration that is out of range, or needs a missing feature of this library, as
 * text; NULL if there is none. */
const char *t3r_config_error(const t3r_config *config);

/* Lays the arena out. On any error *rt is NULL and the arena is untouched. */
t3r_status t3r_init_as(uint64_t digest, t3r_runtime **rt, void *arena, size_t arena_bytes, const t3r_config *config);
static inline t3r_status t3r_init(t3r_runtime **rt, void *arena, size_t arena_bytes, const t3r_config *config)
{
    return t3r_init_as(t3r_header_interface(), rt, arena, arena_bytes, config);
}

/* Binds an arena that was copied or restored from bytes, of exactly the same size. It then has no hooks and no weights,
 * and its inner loops are plain C. T3R_ERR_EPOCH: it was made by another version, or is damaged. */
t3r_status t3r_attach_as(uint64_t digest, t3r_runtime **rt, void *arena, size_t arena_bytes);
static inline t3r_status t3r_attach(t3r_runtime **rt, void *arena, size_t arena_bytes)
{
    return t3r_attach_as(t3r_header_interface(), rt, arena, arena_bytes);
}

/* Returns the configuration, for instance of an arena that was attached: that of t3r_init(), with `clusters`,
 * `cluster_batches` and `refine_stride` as they were chosen. Valid as long as the runtime. NULL without a runtime. */
const t3r_config *t3r_get_config(const t3r_runtime *rt);

/* Binds callbacks (NULL: none). */
t3r_status t3r_set_hooks(t3r_runtime *rt, const t3r_hooks *hooks);

/* Features of processors that variants of the runtime's inner loops use. */
#define T3R_CPU_AVX2 (1u << 0)     /* x86-64 */
#define T3R_CPU_AVX512 (1u << 1)   /* F, BW, CD, DQ and VL of AVX-512 */
#define T3R_CPU_VNNI (1u << 2)     /* AVX512_VNNI, with T3R_CPU_AVX512 */
#define T3R_CPU_SSE41 (1u << 3)    /* x86-64: SSE4.1 and earlier */
#define T3R_CPU_NEON (1u << 8)     /* 64-bit Arm */
#define T3R_CPU_DOTPROD (1u << 9)  /* dot products of 8 bits on it */
#define T3R_CPU_MVE (1u << 10)     /* Arm Cortex-M with vectors (Helium), such as the M55 */
#define T3R_CPU_DSP (1u << 11)     /* Arm Cortex-M with sums of two products, such as the M4 and the M7 */
#define T3R_CPU_SIMD128 (1u << 16) /* WebAssembly */

/* Chooses the inner loops for a processor with these T3R_CPU_... features; 0 = plain C, the default after t3r_init()
 * and t3r_attach(). The processor and its operating system must have them. No bit of any output changes. A firmware
 * that does not call it links none of the variants. T3R_ERR_ARGUMENT: NULL; a bit without a name above; a feature of
 * another architecture, or of another core than the firmware is compiled for; on x86-64 a feature that the processor or
 * its operating system lacks. The loops then stay. On 64-bit Arm a program cannot ask for T3R_CPU_DOTPROD itself: the
 * operating system says so. */
t3r_status t3r_set_cpu(t3r_runtime *rt, uint32_t features);

/* Returns the features that the library finds by itself, for t3r_set_cpu(): on x86-64 those of the processor and its
 * operating system, elsewhere those for which the library is compiled. Only T3R_CPU_DOTPROD may be missing: on 64-bit
 * Arm the operating system reports it. */
uint32_t t3r_cpu_found(void);

/* Returns the features that the inner loops use, as t3r_set_cpu() took them; 0 = plain C, or NULL. */
uint32_t t3r_get_cpu(const t3r_runtime *rt);

/* Binds the weights of the head T3R_HEAD_LEARNED, a whole .t3w file in memory aligned to 16 (NULL: none). Only the
 * pointer is kept: the file is read in place, and must stay unchanged while it is bound. Bind after t3r_init() and
 * again after t3r_attach(). The analysis does not depend on the head, so another head may be bound to a kept analysis.
 * T3R_ERR_ARGUMENT: misaligned. T3R_ERR_WEIGHTS: t3r_weights_error() has the reason. T3R_ERR_STATE: the arena has no
 * room for views. T3R_ERR_UNSUPPORTED: this library has no learned heads. After an error the previous weights stay
 * bound. */
t3r_status t3r_bind_head(t3r_runtime *rt, const void *weights, size_t bytes);

/* Returns the reason why t3r_bind_head() refuses a weight file, as text. NULL if the file is valid: if it is still
 * refused, the head is too large for the arena (t3r_head_column_bytes()). */
const char *t3r_weights_error(const void *weights, size_t bytes);

/* Returns the head_column_bytes that this head needs on views of this width and any height, at least 1. 0 =
 * t3r_weights_error() refuses the file, or the width is not 1..T3R_MAX_SIDE. The default is enough for tiny and small
 * with 8-bit activations. */
uint32_t t3r_head_column_bytes(const void *weights, size_t bytes, uint32_t width);

/* Returns the CRC-32 of the head bound last, 0 if none was. A copied arena keeps it, to identify the file to bind
 * again. */
uint32_t t3r_head_crc(const t3r_runtime *rt);

/* Adds the next context view: converted to planes, resized to the working size, undistorted. The camera belongs to the
 * frame's own pixel grid and must also be in range after resizing. With T3R_DEPTH_STEREO the frame's depth is ignored,
 * and pixels with r = g = b = 0 count as empty.
 *
 * T3R_ERR_FRAME. T3R_ERR_CAMERA: out of range, or more than half of the picture lies beyond what the lens can show.
 * T3R_ERR_UNSUPPORTED: the lens distorts, and this library has no lenses. T3R_ERR_NO_DEPTH: no depth plane, or no
 * measurement in it. T3R_ERR_STATE: there is no room for another view, or there is a scene already (t3r_reset()). After
 * an error no view is added. A lens that shows too little, and a depth plane without a measurement, also discard scene
 * and analysis; all other errors change nothing.
 *
 * With `warm` a view may follow a scene, which it discards. There is always room: a further view replaces the oldest
 * one. Then a depth plane without a measurement discards nothing, but measurements that are lost in resizing discard
 * everything. */
t3r_status t3r_add_view(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera);

/* Adds a view by strips of rows, as a camera delivers them, so that no whole frame need be in memory. A strip has rows
 * row..row + rows - 1 of the colour image, which frame->planes begin with, and depth_row..depth_row + depth_rows - 1 of
 * the depth image, which frame->depth begins with. Everything else of the frame and the camera describes the whole
 * frame, and is the same in every strip. Colour and depth each come in order from row 0 on, independently of each
 * other, and 0 rows are allowed. The strip that completes both adds the view, with the bits of t3r_add_view().
 *
 * A strip from row 0 of both begins a view, and discards an incomplete one; so do t3r_add_view(), t3r_develop(),
 * t3r_reconstruct(), t3r_reset() and t3r_attach(). T3R_ERR_FRAME: also rows beyond the image, or with T3R_PIXEL_NV12 an
 * odd number. T3R_ERR_STATE: also a strip out of order, another frame or camera than before, or with `warm` no room
 * without replacing a view. These two, and T3R_ERR_NO_DEPTH of a strip without a depth plane, keep the earlier strips.
 * T3R_ERR_CAMERA, and T3R_ERR_NO_DEPTH of a view without a measurement, discard them. With T3R_DEPTH_STEREO the rows of
 * depth are ignored. */
t3r_status t3r_add_rows(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint32_t row, uint32_t rows,
                        uint32_t depth_row, uint32_t depth_rows);

/* Discards views, analysis and scene; the configuration stays. Needed before t3r_add_view() once there is a scene. */
t3r_status t3r_reset(t3r_runtime *rt);

/* Analyses the views added so far and builds a scene of them by the request (NULL: by the configuration). It has
 * exactly the budget, or as many Gaussians as there are valid points if they are fewer. Those of rim and backdrop
 * count, so that so many points less are retained.
 *
 * With an importance, the points of the highest importance are retained, with ties in the order of views and rows.
 * Doubtful points and surfaces seen twice then get no special treatment. Heads see the share of points retained about
 * each pixel.
 *
 * With a bounded loss, the build makes the fewest Gaussians predicted to stay within it, at least 1/400 of the points.
 * The prediction is for views between the context's (SPEC.md, "Budget within a loss"). It uses the errors of two trial
 * scenes, of 1/100 and 1/50 of the points, in the context views, and the disagreement of these views. That takes the
 * time of more than two builds; the trials' stages are hashed, too.
 *
 * T3R_ERR_ARGUMENT: a field of the request is out of its range. T3R_ERR_UNSUPPORTED: this library was built without the
 * head, without the allocation, or without bounded losses. T3R_ERR_STATE: there are no views (by stereo, fewer than
 * two); the learned head has no weights; the allocation is `given` and no importance came; or a bounded loss without
 * keep_analysis and refine above 0. These three change nothing. T3R_ERR_CAMERA: a view is more than 1,024 scene units
 * from the first. T3R_ERR_STEREO: no two views can be matched, and t3r_stereo_pair() has the reason. T3R_ERR_CANCELLED.
 * After these three there is no scene, and the views stay. */
t3r_status t3r_reconstruct(t3r_runtime *rt, const t3r_request *request, t3r_scene *scene);

/* Builds another scene of the views analysed last, without analysing them again. Needs keep_analysis; otherwise like
 * t3r_reconstruct(). T3R_ERR_STATE also if there is no analysis. T3R_ERR_CANCELLED: there is no scene, and the
 * analysis stays. */
t3r_status t3r_rebuild(t3r_runtime *rt, const t3r_request *request, t3r_scene *scene);

/* Builds the fewest Gaussians that draw every context view at least_psnr_q8 or more, 1..T3R_MAX_PSNR_Q8, of the views
 * analysed last. That is measured: each scene that is tried draws all context views into `picture`, and is compared
 * with the views as they were analysed, over all their pixels, black where it shows nothing. Other
 * views may be worse. The budget is the most. Numbers from 1/128 of it are doubled, then the gap to the last number
 * that is too small is halved, to 1/64: at most 16 builds. If none is enough, the scene of the number that draws them
 * best is returned, and found->psnr_q8 is below least_psnr_q8.
 *
 * picture: memory for `rgb`, of the working size; it holds a context view afterwards. Statuses are those of
 * t3r_rebuild(). T3R_ERR_ARGUMENT also: NULL for anything except `request`, a PSNR out of range, a picture of another
 * size, or a bounded loss in the request. T3R_ERR_UNSUPPORTED also: built without bounded losses. */
t3r_status t3r_rebuild_least(t3r_runtime *rt, const t3r_request *request, uint32_t least_psnr_q8,
                             const t3r_target *picture, t3r_scene *scene, t3r_least *found);

/* Returns how context view `view` got its depth with T3R_DEPTH_STEREO, also after T3R_ERR_STEREO. T3R_PAIR_OK:
 * *partner is the view that most of it came from. Any other: the view has no depth and adds no points, and the value
 * is the reason why the most promising pair was refused. *partner is `view` if there is none: by sensor, out of range,
 * before an analysis. */
t3r_pair t3r_stereo_pair(const t3r_runtime *rt, uint32_t view, uint32_t *partner);

/* Streams (t3r_config.stream): takes the next keyframe of a moving camera into the map, which is the scene in the
 * arena. The map holds at most the configuration's `gaussians` over any number of keyframes, and a call takes bounded
 * time. The caller chooses which frames are keyframes. t3r_render() and t3r_get_scene() work in between, and
 * t3r_reset() empties the map. `report` may be NULL; it is all 0 after an error, unless the keyframe was taken.
 *
 * Pixels that the map already shows add nothing. The others compete with the Gaussians of the map by one score, texture
 * density against blue noise. Allocations by SuperClusters count as `pixel`, so that the score means the same in every
 * keyframe. The remaining Gaussians grow over the gaps. Refinement on the last `views` keyframes then corrects the
 * Gaussians that these see as finely as the Gaussian's own keyframe.
 *
 * The map has the scale of the first keyframe. Its origin follows the camera by whole scene units, and Gaussians more
 * than 1,024 scene units away are discarded. A Gaussian's `view` is its keyframe's number modulo `views`.
 *
 * With `gate`, a frame that cannot be trusted is refused: the call returns T3R_OK, report->refusal has the reason, and
 * the map, the keyframes and their gains are as before. The next frame is then due. Exposure, blur, covering and
 * contradiction may last: after 4 to 32 refusals in a row the next such frame is taken. With `align`, the map moves
 * with poses that jumped, after 2 refusals in a row, if the frame then agrees with it. Else, if the frame that is taken
 * contradicts the map, and its camera is within half a scene unit of the last one along each axis, a new piece of the
 * map begins. Earlier keyframes are then forgotten, and earlier Gaussians leave as soon as a keyframe covers them and
 * does not show them.
 *
 * T3R_ERR_STATE: the arena is not one for streams, the learned head has no weights, or the allocation is `given`.
 * T3R_ERR_UNSUPPORTED: this library has no streams, or no lenses and the camera's distorts. T3R_ERR_FRAME.
 * T3R_ERR_CAMERA: out of range, or the lens shows too little; without `gate` also more than 1,024 scene units from the
 * origin. T3R_ERR_NO_DEPTH: without `gate`, a frame without a measured depth. These five change nothing.
 * T3R_ERR_CANCELLED: the keyframe adds nothing; from its comparison with earlier keyframes on, refinement uses neither
 * it nor the one of `views` keyframes ago, and Gaussians that it contradicts may be gone. T3R_ERR_CANCELLED during
 * refinement: the keyframe is taken, with a report, and passes are missing; report->keyframes is above 0 then. The map
 * stays valid and within its cap after any error. */
t3r_status t3r_stream_keyframe(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                               t3r_stream_report *report);

/* Streams: shows the map a frame again that was a keyframe before, from a recording. It adds no Gaussian, removes none,
 * and nothing fades: refinement corrects the map, by this frame and the `views` - 1 shown before it. A map forgets what
 * its first keyframes agreed on; after the last frame a round or two over all keyframes give it back. Keyframes that
 * follow each other must differ, so take them in a mixed order. `round` is 1 in the first round, 2 in the second:
 * corrections are divided by 1 + round, 1..T3R_MAX_ROUND. The frame's planes replace those of the oldest live keyframe.
 * Exposure is not brought to the mean, and the gate does not judge.
 *
 * Statuses are those of t3r_stream_keyframe(). T3R_ERR_STATE also if there is no keyframe, T3R_ERR_NO_DEPTH and
 * T3R_ERR_CAMERA with `gate`, too, and T3R_ERR_ARGUMENT also for a round out of range. After T3R_ERR_CANCELLED in
 * refinement passes are missing. */
#define T3R_MAX_ROUND 255u
t3r_status t3r_stream_again(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint32_t round);

/* Computes the overlap of a picture of width x height by this camera with the newest keyframe, 0..256, in 1/256. It is
 * the lesser of two shares: the share of the keyframe's points that the picture would show; and the number of cells of
 * an 8 x 8 grid that these points fall on in the picture, over the number in their own picture. The camera's
 * distortion is ignored. Use it to choose keyframes: below about 70 % the next one is due. T3R_ERR_STATE: there is no
 * keyframe yet. T3R_ERR_CAMERA, T3R_ERR_UNSUPPORTED: see t3r_stream_keyframe(). */
t3r_status t3r_stream_overlap(const t3r_runtime *rt, const t3r_camera *camera, uint32_t width, uint32_t height,
                              uint32_t *overlap_q8);

/* Returns the scene in the arena, for instance after t3r_attach(). T3R_ERR_STATE if there is none. */
t3r_status t3r_get_scene(const t3r_runtime *rt, t3r_scene *scene);

/* Build a scene from a file: the first starts an empty scene in the given frame (exponent -24..24, |origin| < 2^62) and
 * discards the views, the second appends a Gaussian. T3R_ERR_ARGUMENT: a field is out of range; every one is checked.
 * T3R_ERR_STATE: the arena is a stream's, or there is no scene to append to. T3R_ERR_FULL: the arena holds no more
 * Gaussians. */
t3r_status t3r_scene_begin(t3r_runtime *rt, const t3r_scene_frame *frame);
t3r_status t3r_scene_append(t3r_runtime *rt, const t3r_gaussian *gaussian);

/* Computes the colour of a Gaussian seen along a direction, from spherical harmonics (SPEC, "Harmonics"). The scene
 * holds one colour for all directions, so a program that draws a scene with harmonics appends its Gaussians again for
 * each view. `degree` is 0..T3R_HARMONICS_DEGREE_MOST. coefficients_q12 are (degree + 1)^2 times r g b, in 1/2^12.
 * `direction` is from the camera to the mean, of any length in any unit; at length 0 only degree 0 counts. colour_q7 is
 * as in t3r_gaussian. T3R_ERR_ARGUMENT: `degree` is out of range. */
t3r_status t3r_harmonics_colour(const int16_t *coefficients_q12, uint32_t degree, const int32_t direction[3],
                                uint16_t colour_q7[3]);

/* Draws the scene in the arena as seen by the camera, which has no distortion: targets are pinhole. Without
 * keep_analysis and `warm` the views are discarded, because the raster uses the memory of their planes. T3R_ERR_STATE:
 * there is no scene. T3R_ERR_ARGUMENT: sizes or strides are out of range, or depth or alpha is not aligned for its
 * type. T3R_ERR_CAMERA: out of range; a distortion, which is refused and not drawn; or more than 1,024 scene units from
 * the origin. T3R_ERR_CANCELLED: the target is partly drawn. */
t3r_status t3r_render(t3r_runtime *rt, const t3r_camera *camera, const t3r_target *target);

/* Returns the number of passes over the scene that the last t3r_render() took: 1 if the arena had room for all splats.
 */
uint32_t t3r_render_passes(const t3r_runtime *rt);

/* Returns the number of refinement passes that the last build took: at most `refine`, or 5/4 of it where passes
 * compare a part of the pixels. 0 without a runtime, before a build, and with a stream. */
uint32_t t3r_refinement_passes(const t3r_runtime *rt);

/* Returns the camera of context view `view`, at the working size and without distortion, as the last analysis placed
 * it: with `align` its pose may be corrected. T3R_ERR_ARGUMENT: NULL, or a view that was not added. */
t3r_status t3r_view_camera(const t3r_runtime *rt, uint32_t view, t3r_camera *camera);

/* Returns the gains of r, g and b, in 1/2^14, that bring the colours of context view `view` to the exposure of the
 * scene, as the last analysis found them. Without `exposure`, and before an analysis, all are 2^14. To draw the scene
 * in the exposure of that view, divide by them. T3R_ERR_ARGUMENT: NULL, or a view that was not added. */
t3r_status t3r_view_gain(const t3r_runtime *rt, uint32_t view, uint16_t gain_q14[3]);

/* Runs the image stage of t3r_add_view() only: converts any frame to 8-bit RGB and 16-bit depth of the working size,
 * undistorted, in the caller's memory. depth_out may be NULL, and so may the frame's depth. *undistorted becomes the
 * camera of the result. T3R_ERR_STATE unless the runtime is empty. */
t3r_status t3r_develop(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint8_t *rgb_out,
                       uint16_t *depth_out, t3r_camera *undistorted);

/* ---- pixels of devices -------------------------------------------------------------------------------------------
 *
 * These calls convert rows of pixels in the caller's memory: a camera's to R G B, before t3r_add_view() or
 * t3r_add_rows(), and R G B to a display's, after t3r_render(). They need no runtime. Input and output must not
 * overlap. Each rounding is to nearest (SPEC, "Pixels of devices"). A firmware that does not call them links none of
 * them. T3R_ERR_ARGUMENT: NULL, a row that is too short, or a value without a name; nothing is written. */

/* The layout of a pixel in bytes. */
typedef uint32_t t3r_packing;
enum {
    T3R_PACKED_RGB565,    /* 2 bytes, the low one first: blue in bits 0..4, green in 5..10, red in 11..15 */
    T3R_PACKED_RGB565_BE, /* the same, with the high byte first, as most camera modules send it */
    T3R_PACKED_RGBA,      /* 4 bytes: R G B A */
    T3R_PACKED_BGRA,      /* 4 bytes: B G R A */
    T3R_PACKING_COUNT
};

/* The colours of the first two pixels of a Bayer pattern's first row, and then of its second row. */
typedef uint32_t t3r_bayer;
enum { T3R_BAYER_RGGB, T3R_BAYER_GRBG, T3R_BAYER_GBRG, T3R_BAYER_BGGR, T3R_BAYER_COUNT };

/* Converts `width` pixels, 1 or more, to R G B. Their alpha is ignored. */
t3r_status t3r_unpack_row(t3r_packing packing, const uint8_t *packed, uint32_t width, uint8_t *rgb);

/* Converts row `y` of a picture in a Bayer pattern with 8 bits a pixel to R G B of the same width, 2 or more, by
 * bilinear interpolation. `order` is that of the whole picture. `above` and `below` are rows y - 1 and y + 1. The
 * picture is mirrored at its edges: the first row has row 1 as `above`, the last row the one before it as `below`. */
t3r_status t3r_demosaic_row(t3r_bayer order, uint32_t y, const uint8_t *above, const uint8_t *row, const uint8_t *below,
                            uint32_t width, uint8_t *rgb);

/* Converts `width` pixels R G B, 1 or more, to a display's. alpha_q15 is the row of t3r_target, which becomes the alpha
 * of RGBA and BGRA; the colours of a view are premultiplied by it. NULL = all pixels are opaque. */
t3r_status t3r_pack_row(t3r_packing packing, const uint8_t *rgb, const uint16_t *alpha_q15, uint32_t width,
                        uint8_t *packed);

/* Draws a row of a view over a background colour r g b, in place. rgb and alpha_q15 are rows of t3r_target. */
t3r_status t3r_composite_row(uint8_t *rgb, const uint16_t *alpha_q15, uint32_t width, const uint8_t background[3]);

/* ---- errors in words ---------------------------------------------------------------------------------------------
 *
 * After a call returned an error, the function of its name with the suffix _error gives the reason: which argument, its
 * value and what is allowed, or which call is missing. It takes the status, the arguments of the call, and memory for a
 * sentence, T3R_ERROR_BYTES of which hold any. It runs the checks of the call again and changes nothing, so call it
 * before anything else changes the runtime or the arguments. Returns `text`, or a constant text if it is NULL. For an
 * error that no check explains, such as T3R_ERR_CANCELLED, the text is that of t3r_error_text(), as for the calls
 * without such a function. The inline ones pass the program's digest, as their calls do. A firmware that does not call
 * them links neither them nor their sentences. */
#define T3R_ERROR_BYTES 320
const char *t3r_plan_as_error(t3r_status status, uint64_t digest, const t3r_config *config, const t3r_plan_info *plan,
                              char *text, size_t text_bytes);
static inline const char *t3r_plan_error(t3r_status status, const t3r_config *config, const t3r_plan_info *plan,
                                         char *text, size_t text_bytes)
{
    return t3r_plan_as_error(status, t3r_header_interface(), config, plan, text, text_bytes);
}
const char *t3r_plan_bytes_as_error(t3r_status status, uint64_t digest, const t3r_config *config,
                                    const size_t *min_bytes, const size_t *bytes, char *text, size_t text_bytes);
static inline const char *t3r_plan_bytes_error(t3r_status status, const t3r_config *config, const size_t *min_bytes,
                                               const size_t *bytes, char *text, size_t text_bytes)
{
    return t3r_plan_bytes_as_error(status, t3r_header_interface(), config, min_bytes, bytes, text, text_bytes);
}
const char *t3r_plan_within_as_error(t3r_status status, uint64_t digest, size_t bytes, const t3r_config *config,
                                     char *text, size_t text_bytes);
static inline const char *t3r_plan_within_error(t3r_status status, size_t bytes, const t3r_config *config, char *text,
                                                size_t text_bytes)
{
    return t3r_plan_within_as_error(status, t3r_header_interface(), bytes, config, text, text_bytes);
}
const char *t3r_set_preset_as_error(t3r_status status, uint64_t digest, t3r_preset preset, const t3r_config *config,
                                    const char *const *weights, char *text, size_t text_bytes);
static inline const char *t3r_set_preset_error(t3r_status status, t3r_preset preset, const t3r_config *config,
                                               const char *const *weights, char *text, size_t text_bytes)
{
    return t3r_set_preset_as_error(status, t3r_header_interface(), preset, config, weights, text, text_bytes);
}
const char *t3r_init_as_error(t3r_status status, uint64_t digest, t3r_runtime *const *rt, const void *arena,
                              size_t arena_bytes, const t3r_config *config, char *text, size_t text_bytes);
static inline const char *t3r_init_error(t3r_status status, t3r_runtime *const *rt, const void *arena,
                                         size_t arena_bytes, const t3r_config *config, char *text, size_t text_bytes)
{
    return t3r_init_as_error(status, t3r_header_interface(), rt, arena, arena_bytes, config, text, text_bytes);
}
const char *t3r_attach_as_error(t3r_status status, uint64_t digest, t3r_runtime *const *rt, const void *arena,
                                size_t arena_bytes, char *text, size_t text_bytes);
static inline const char *t3r_attach_error(t3r_status status, t3r_runtime *const *rt, const void *arena,
                                           size_t arena_bytes, char *text, size_t text_bytes)
{
    return t3r_attach_as_error(status, t3r_header_interface(), rt, arena, arena_bytes, text, text_bytes);
}
const char *t3r_set_cpu_error(t3r_status status, const t3r_runtime *rt, uint32_t features, char *text,
                              size_t text_bytes);
const char *t3r_bind_head_error(t3r_status status, const t3r_runtime *rt, const void *weights, size_t bytes, char *text,
                                size_t text_bytes);
const char *t3r_add_view_error(t3r_status status, const t3r_runtime *rt, const t3r_frame *frame,
                               const t3r_camera *camera, char *text, size_t text_bytes);
const char *t3r_add_rows_error(t3r_status status, const t3r_runtime *rt, const t3r_frame *frame,
                               const t3r_camera *camera, uint32_t row, uint32_t rows, uint32_t depth_row,
                               uint32_t depth_rows, char *text, size_t text_bytes);
const char *t3r_reconstruct_error(t3r_status status, const t3r_runtime *rt, const t3r_request *request,
                                  const t3r_scene *scene, char *text, size_t text_bytes);
const char *t3r_rebuild_error(t3r_status status, const t3r_runtime *rt, const t3r_request *request,
                              const t3r_scene *scene, char *text, size_t text_bytes);
const char *t3r_rebuild_least_error(t3r_status status, const t3r_runtime *rt, const t3r_request *request,
                                    uint32_t least_psnr_q8, const t3r_target *picture, const t3r_scene *scene,
                                    const t3r_least *found, char *text, size_t text_bytes);
const char *t3r_stream_keyframe_error(t3r_status status, const t3r_runtime *rt, const t3r_frame *frame,
                                      const t3r_camera *camera, const t3r_stream_report *report, char *text,
                                      size_t text_bytes);
const char *t3r_stream_again_error(t3r_status status, const t3r_runtime *rt, const t3r_frame *frame,
                                   const t3r_camera *camera, uint32_t round, char *text, size_t text_bytes);
const char *t3r_stream_overlap_error(t3r_status status, const t3r_runtime *rt, const t3r_camera *camera, uint32_t width,
                                     uint32_t height, const uint32_t *overlap_q8, char *text, size_t text_bytes);
const char *t3r_get_scene_error(t3r_status status, const t3r_runtime *rt, const t3r_scene *scene, char *text,
                                size_t text_bytes);
const char *t3r_scene_begin_error(t3r_status status, const t3r_runtime *rt, const t3r_scene_frame *frame, char *text,
                                  size_t text_bytes);
const char *t3r_scene_append_error(t3r_status status, const t3r_runtime *rt, const t3r_gaussian *gaussian, char *text,
                                   size_t text_bytes);
const char *t3r_render_error(t3r_status status, const t3r_runtime *rt, const t3r_camera *camera,
                             const t3r_target *target, char *text, size_t text_bytes);
const char *t3r_view_camera_error(t3r_status status, const t3r_runtime *rt, uint32_t view, const t3r_camera *camera,
                                  char *text, size_t text_bytes);
const char *t3r_view_gain_error(t3r_status status, const t3r_runtime *rt, uint32_t view, const uint16_t gain_q14[3],
                                char *text, size_t text_bytes);
const char *t3r_develop_error(t3r_status status, const t3r_runtime *rt, const t3r_frame *frame,
                              const t3r_camera *camera, const uint8_t *rgb_out, const uint16_t *depth_out,
                              const t3r_camera *undistorted, char *text, size_t text_bytes);
const char *t3r_unpack_row_error(t3r_status status, t3r_packing packing, const uint8_t *packed, uint32_t width,
                                 const uint8_t *rgb, char *text, size_t text_bytes);
const char *t3r_demosaic_row_error(t3r_status status, t3r_bayer order, uint32_t y, const uint8_t *above,
                                   const uint8_t *row, const uint8_t *below, uint32_t width, const uint8_t *rgb,
                                   char *text, size_t text_bytes);
const char *t3r_pack_row_error(t3r_status status, t3r_packing packing, const uint8_t *rgb, const uint16_t *alpha_q15,
                               uint32_t width, const uint8_t *packed, char *text, size_t text_bytes);
const char *t3r_composite_row_error(t3r_status status, const uint8_t *rgb, const uint16_t *alpha_q15, uint32_t width,
                                    const uint8_t background[3], char *text, size_t text_bytes);

/* Returns the version of the library, "major.minor.patch". */
const char *t3r_version(void);

/* Returns the features that this library was built with, as T3R_HAS_... (trim3r_features.h). */
uint32_t t3r_features(void);

/* Returns a short English sentence for a status. Never NULL. */
const char *t3r_error_text(t3r_status status);
/* Return stable lower-case names, as printed by the command line and the tables. NULL = out of range, or one of the
 * values ..._CONFIGURED. */
const char *t3r_stage_name(t3r_stage stage);
const char *t3r_allocation_name(t3r_allocation allocation);
const char *t3r_head_name(t3r_head head);
const char *t3r_depth_name(t3r_depth depth);
const char *t3r_preset_name(t3r_preset preset);
const char *t3r_wavelet_name(t3r_wavelet wavelet);
const char *t3r_pixel_format_name(t3r_pixel_format format);
const char *t3r_refusal_name(t3r_refusal refusal);
/* Returns whether two views can be matched, or the reason why not, as text for people. Never NULL. */
const char *t3r_pair_text(t3r_pair pair);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif
#endif
