/* trim3r: a few posed camera frames to a budgeted set of 3-D Gaussians, and views of it, in integers.
 *
 * The whole interface of the runtime. No heap, no floating point, no operating system, no writable
 * globals; the caller supplies one arena and everything lives in it. The same frames, settings and
 * weights give the same bits on every processor. Field names carry their fixed-point format: depth_q20
 * has 20 fraction bits. Each rounding is written down in runtime/SPEC.md.
 *
 * Conventions: pixel (0, 0) is the centre of the top-left pixel; cameras look along +z, x right, y down;
 * poses are camera-to-world. "World units" are those of the poses and of the depth (metres where the
 * source has metres); "scene units" are world units times a power of two (t3r_scene_frame).
 *
 * Copyright 2026 the trim3r developers. Licensed under the Apache License, Version 2.0. */
#ifndef TRIM3R_H
#define TRIM3R_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r_arena.h"

#ifdef __cplusplus
extern "C" {
#endif

#define T3R_VERSION "0.1.0"
/* Raised by every change of any output bit; recordings and scenes carry the epoch they were made in. */
#define T3R_BITS_EPOCH 6

#define T3R_MAX_SIDE 4096u        /* largest width or height of working size, frame or target, in pixels */
#define T3R_MIN_SIDE 8u           /* smallest working width or height, in pixels */
#define T3R_STEREO_LEAST_SIDE 32u /* smallest working width or height with depth by stereo, in pixels */
#define T3R_MAX_VIEWS 16u         /* most context views */
#define T3R_MAX_CLUSTERS 512u     /* most SuperClusters */
#define T3R_MAX_GAUSSIANS (1u << 24)
#define T3R_MAX_REFINEMENTS 16u
#define T3R_MAX_LEVELS 5u /* most wavelet levels */
#define T3R_MAX_HEAD_COLUMN_BYTES 65536u
#define T3R_MAX_LOSS_Q8 2560u /* 10 dB */
#define T3R_MAX_WORKERS 16u

typedef enum t3r_status {
    T3R_OK = 0,
    T3R_ERR_ARGUMENT = -1,  /* a null pointer or a number outside its documented range */
    T3R_ERR_CONFIG = -2,    /* a t3r_config field outside its documented range */
    T3R_ERR_ARENA = -3,     /* the arena is smaller than t3r_plan() asks, or misaligned */
    T3R_ERR_FRAME = -4,     /* a frame whose format, size or stride cannot be read */
    T3R_ERR_CAMERA = -5,    /* intrinsics, distortion or pose outside their documented range */
    T3R_ERR_STATE = -6,     /* calls out of order: no views yet, too many views, no analysis kept */
    T3R_ERR_NO_DEPTH = -7,  /* a context view without a single valid depth */
    T3R_ERR_CANCELLED = -8, /* the progress callback asked to stop */
    T3R_ERR_EPOCH = -9,     /* a copied arena made by another version, layout or bits epoch */
    T3R_ERR_FULL = -10,     /* no room for another Gaussian in the scene */
    T3R_ERR_WEIGHTS = -11,  /* weights that are foreign, damaged, of another epoch, or too large a head for the arena */
    T3R_ERR_STEREO = -12    /* no depth can be made of the views: t3r_stereo_pair() says why */
} t3r_status;

/* The stages in the order in which the data passes them. */
typedef enum t3r_stage {
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
} t3r_stage;

typedef enum t3r_pixel_format {
    T3R_PIXEL_RGB24, /* 3 bytes a pixel: R G B */
    T3R_PIXEL_BGR24, /* 3 bytes a pixel: B G R */
    T3R_PIXEL_GREY,  /* 1 byte a pixel */
    T3R_PIXEL_YUYV,  /* 4:2:2, Y0 U Y1 V; even width; BT.601 limited range */
    T3R_PIXEL_UYVY,  /* 4:2:2, U Y0 V Y1; even width; BT.601 limited range */
    T3R_PIXEL_NV12,  /* 4:2:0, a Y plane and an interleaved UV plane; even width and height; BT.601 limited range */
    T3R_PIXEL_FORMAT_COUNT
} t3r_pixel_format;

/* One captured instant. The memory stays the caller's and is read only during t3r_add_view(). */
typedef struct t3r_frame {
    t3r_pixel_format format;
    uint32_t width, height;             /* pixels; 2..T3R_MAX_SIDE */
    const uint8_t *planes[2];           /* plane 1 only for NV12 */
    uint32_t stride_bytes[2];           /* bytes from row to row, below 2^19 */
    const uint8_t *depth;               /* Z16: little-endian 16-bit steps along z, 0 = no measurement; NULL = none */
    uint32_t depth_width, depth_height; /* 2..T3R_MAX_SIDE; registered to the colour image, not always of its size */
    uint32_t depth_stride_bytes;
    uint64_t depth_unit_q40; /* world units a step, 1..2^47 - 1; 1 mm in metres is 1099511628 */
} t3r_frame;

typedef enum t3r_distortion {
    T3R_DISTORTION_NONE,
    T3R_DISTORTION_RADTAN,  /* k1 k2 p1 p2 k3 (Brown-Conrady; OpenCV "plumb_bob") */
    T3R_DISTORTION_FISHEYE, /* k1 k2 k3 k4 (Kannala-Brandt; OpenCV "equidistant") */
    T3R_DISTORTION_COUNT
} t3r_distortion;

/* A calibrated, posed pinhole camera, for the pixel grid of the frame or target it comes with. */
typedef struct t3r_camera {
    int32_t fx_q16, fy_q16; /* focal lengths in pixels, [8, 16384) */
    int32_t cx_q16, cy_q16; /* principal point in pixels, (-16384, 16384) */
    t3r_distortion distortion;
    int32_t distortion_q24[5]; /* |p1|, |p2| below 16 */
    int64_t position_q32[3];   /* camera centre in world units, |x| < 2^62 */
    int32_t rotation_q30[4];   /* quaternion w x y z, camera to world; any norm in [0.5, 1.5]: normalised inside */
} t3r_camera;

typedef enum t3r_wavelet { T3R_WAVELET_DB2, T3R_WAVELET_HAAR, T3R_WAVELET_CDF53, T3R_WAVELET_COUNT } t3r_wavelet;

/* How the budget Z is spread over the valid points (runtime/SPEC.md, "Budget"). */
typedef enum t3r_allocation {
    T3R_ALLOCATE_DENSITY, /* over SuperClusters by |SC| x Texture(SC)^gamma, inside one by texture density */
    T3R_ALLOCATE_PAPER,   /* GaussianTrim3R eq. 2: lowest texture first, each keeps N % */
    T3R_ALLOCATE_PIXEL,   /* texture density without clusters */
    T3R_ALLOCATE_UNIFORM, /* blue noise alone */
    T3R_ALLOCATE_RANDOM,  /* white noise of the seed */
    T3R_ALLOCATE_GIVEN,   /* by an importance of each pixel: t3r_reconstruct_given(), t3r_rebudget_given() */
    T3R_ALLOCATE_COUNT
} t3r_allocation;

typedef enum t3r_head {
    T3R_HEAD_ANALYTIC, /* a disc on the surface, as wide as its kept neighbours are apart */
    T3R_HEAD_MOMENT,   /* moments of the pruned pixels that lie nearest in position and colour */
    T3R_HEAD_NONE,     /* the unpruned pixel's own splat: `analytic` with adapt 0 (the baseline `random`) */
    T3R_HEAD_LEARNED,  /* a network sees image, mask and density: t3r_bind_head() */
    T3R_HEAD_COUNT
} t3r_head;

/* Where depth comes from. */
typedef enum t3r_depth {
    T3R_DEPTH_SENSOR, /* the frames' own */
    T3R_DEPTH_STEREO, /* the colours of two and more posed views; what depth frames have is not looked at */
    T3R_DEPTH_COUNT
} t3r_depth;

/* Whether two views can be matched, and why not. */
typedef enum t3r_pair {
    T3R_PAIR_OK,
    T3R_PAIR_NO_BASELINE, /* both cameras stand in one place and look the same way */
    T3R_PAIR_ROTATION,    /* both cameras stand in one place, but look different ways */
    T3R_PAIR_OVERLAP,     /* too little is in both pictures */
    T3R_PAIR_PARALLAX,    /* whatever is in both pictures hardly moves between them */
    T3R_PAIR_SCALE,       /* the baseline in world units leaves no depth unit */
    T3R_PAIR_COUNT
} t3r_pair;

/* Settings. t3r_default_config() fills every field; change what you need before t3r_init(). */
typedef struct t3r_config {
    uint32_t width, height; /* working size of the context views, T3R_MIN_SIDE..T3R_MAX_SIDE */
    uint32_t views;         /* most context views, 0..T3R_MAX_VIEWS; 0 = an arena that only renders */
    uint32_t max_gaussians; /* hard cap on the scene, 1..T3R_MAX_GAUSSIANS */
    uint32_t gaussians;     /* the budget Z, 1..max_gaussians */
    uint32_t render_width;  /* largest target, 1..T3R_MAX_SIDE */
    uint32_t render_height;
    t3r_wavelet wavelet;
    uint32_t wavelet_levels;   /* 1..T3R_MAX_LEVELS */
    uint32_t clusters;         /* K, 1..T3R_MAX_CLUSTERS */
    uint32_t cluster_batches;  /* mini-batches before the assignment pass, 0..1024 */
    uint32_t colour_weight_q8; /* weight of r, g, b against x, y, z in the K-means metric, 0..1024; 256 = 1 */
    t3r_allocation allocation;
    uint32_t keep_percent; /* N of the allocation `paper`, 0..100 */
    uint32_t gamma_q8;     /* exponent of texture, 0..512; 256 = 1 */
    uint32_t shuffle;      /* 1 = SuperClusters exchange their textures at random: how much the ranking is worth */
    t3r_head head;
    uint32_t adapt;             /* 0 = the head is told that nothing was pruned: how much adapting is worth */
    uint32_t head_column_bytes; /* work of a learned head, 0..65,536 a column: t3r_head_column_bytes() */
    uint32_t refinements;       /* passes of refinement on the context views, 0..T3R_MAX_REFINEMENTS */
    t3r_depth depth;            /* by stereo, width and height must be 32 and more */
    uint32_t fill_radius;       /* depth holes bracketed within this many pixels are filled, 0..8; 0 = none */
    uint32_t bridge_radius;     /* wider ones of a sensor bracketed within so many are bridged, 0..255; 0 = none */
    uint32_t flying;            /* 1 = points between surfaces, or in front of what another view measured, come last */
    uint32_t redundancy;        /* 1 = small budgets pass over points that another view covers */
    uint32_t exposure;          /* 1 = colours of all views are brought to their mean exposure */
    uint32_t keep_analysis;     /* 1 = planes outlive the build, so that t3r_rebudget() works */
    uint32_t stream;            /* 1 = a map of at most `gaussians` follows a camera: t3r_stream_keyframe() alone, by
                                   depth of a sensor */
    uint32_t half_life;         /* of a stream: keyframes that halve the density of what they do not see, 0..1024;
                                   0 = nothing fades */
    uint32_t workers; /* tasks that t3r_hooks.parallel_for may run at once, 1..T3R_MAX_WORKERS: each has a part
                         of the arena for itself. Never changes a bit. */
    uint32_t seed;    /* of the K-means, of the allocation `random`, and of blue-noise ties */
} t3r_config;

/* Where the scene's fixed-point frame stands in the world: world = origin + scene x 2^exponent. */
typedef struct t3r_scene_frame {
    int64_t origin_q32[3]; /* world units: the first context camera's centre */
    int32_t exponent;      /* so chosen that the median depth is in [1, 2) scene units */
} t3r_scene_frame;

/* One Gaussian. Its covariance is F F^T with F = factor x 2^factor_exponent, row-major 3x3, in scene
 * units: positive semi-definite by construction and precise over the whole dynamic range. */
typedef struct t3r_gaussian {
    int32_t position_q20[3]; /* mean, scene units */
    int16_t factor[9];       /* mantissas of F */
    int8_t factor_exponent;  /* F = factor x 2^factor_exponent; -60..15 */
    uint8_t view;            /* index of the source view */
    uint16_t colour_q7[3];   /* r g b, 0..255 in Q7 (0..32640) */
    uint16_t opacity_q15;    /* 0..32767 */
    uint8_t confidence;      /* 255 = measured, less = filled or doubtful */
    uint8_t reserved[3];     /* 0 */
} t3r_gaussian;

/* A view on the scene in the arena; valid until the next call that builds or edits it. */
typedef struct t3r_scene {
    t3r_scene_frame frame;
    const t3r_gaussian *gaussians;
    uint32_t count;
    uint32_t valid_points; /* pixels of the context views with a depth before hole filling, measured or matched; 0 of a
                            * stream */
} t3r_scene;

/* Where a render goes. rgb may be NULL when only depth or alpha are wanted. Black background. */
typedef struct t3r_target {
    uint32_t width, height; /* 1..render_width, 1..render_height */
    uint8_t *rgb;           /* R G B, 3 bytes a pixel */
    uint32_t rgb_stride_bytes;
    uint32_t *depth_q20; /* camera z, scene units, of the splat at which transmittance falls below 1/2; 0 = none */
    uint32_t depth_stride_bytes; /* a multiple of 4 */
    uint16_t *alpha_q15;         /* 1 - transmittance, 0..32767 */
    uint32_t alpha_stride_bytes; /* a multiple of 2 */
} t3r_target;

/* Optional callbacks, re-bound by t3r_attach(); zero-initialise what is not used. */
typedef struct t3r_hooks {
    void *user;
    /* Called between bounded pieces of long work (a view, a batch, 64 tiles); a return other than 0 cancels it. */
    int (*progress)(void *user, t3r_stage stage, uint32_t done, uint32_t total);
    /* When set, every stage of t3r_reconstruct(), t3r_rebudget() and t3r_render() is hashed (SPEC, "Hash"). */
    void (*stage_hash)(void *user, t3r_stage stage, uint64_t hash);
    /* Runs task(context, index, worker) for each index in 0..count-1, in any order, on any threads, and returns when
     * all are done. `worker` is below t3r_config.workers, and no two tasks that run at the same time have the same one:
     * it is the number of the thread. The runtime never calls the hook from within a task. */
    void (*parallel_for)(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                         void *context);
} t3r_hooks;

/* One line of the plan: a buffer of the arena. */
typedef struct t3r_plan_buffer {
    const char *name;
    size_t offset, bytes; /* within an arena of `bytes` (t3r_plan_info) */
    t3r_stage first, last;
} t3r_plan_buffer;

typedef struct t3r_plan_info {
    size_t min_bytes; /* one byte less is refused */
    size_t bytes;     /* a view takes one pass, unless most of its splats are many tiles wide */
    uint32_t buffer_count;
    t3r_plan_buffer buffers[T3R_BUFFER_COUNT]; /* as laid out in an arena of `bytes` */
    uint64_t operations[T3R_STAGE_COUNT];      /* upper bound of inner-loop steps, a stage */
} t3r_plan_info;

typedef struct t3r_runtime t3r_runtime;

/* Defaults for a working size, number of views and budget. Never fails. */
t3r_config t3r_default_config(uint32_t width, uint32_t height, uint32_t views, uint32_t gaussians);

/* What an arena for this configuration needs. T3R_ERR_CONFIG names no field: t3r_config_error() does. */
t3r_status t3r_plan(const t3r_config *config, t3r_plan_info *plan);

/* The first field of the configuration that is out of range, as text; NULL when all are in range. */
const char *t3r_config_error(const t3r_config *config);

/* Lays the arena out. On any error *rt is NULL and the arena is untouched. */
t3r_status t3r_init(t3r_runtime **rt, void *arena, size_t arena_bytes, const t3r_config *config);

/* Re-binds an arena that was copied or restored from bytes, of the very same size; hooks start empty, no weights are
 * bound, and inner loops are plain C. T3R_ERR_EPOCH when it was made by another version or is damaged. */
t3r_status t3r_attach(t3r_runtime **rt, void *arena, size_t arena_bytes);

/* Binds callbacks (NULL: none). */
t3r_status t3r_set_hooks(t3r_runtime *rt, const t3r_hooks *hooks);

/* Features of processors that variants of the runtime's inner loops use. */
#define T3R_CPU_AVX2 (1u << 0)     /* x86-64 */
#define T3R_CPU_AVX512 (1u << 1)   /* F, BW, DQ and VL of AVX-512 */
#define T3R_CPU_VNNI (1u << 2)     /* AVX512_VNNI, with T3R_CPU_AVX512 */
#define T3R_CPU_NEON (1u << 8)     /* 64-bit Arm */
#define T3R_CPU_DOTPROD (1u << 9)  /* its dot products of 8 bits */
#define T3R_CPU_MVE (1u << 10)     /* Arm Cortex-M */
#define T3R_CPU_SIMD128 (1u << 16) /* WebAssembly */

/* Chooses the inner loops for a processor that has these T3R_CPU_... features (0, as after t3r_init() and t3r_attach():
 * plain C). The caller warrants that the processor and its operating system have them. No bit of any output changes.
 * A firmware that does not call it links none of the variants. */
t3r_status t3r_set_cpu(t3r_runtime *rt, uint32_t features);

/* Binds the weights of the head T3R_HEAD_LEARNED, a whole .t3w file in memory aligned to 16 (NULL: none). Only the
 * pointer is kept: the memory stays the caller's, is read in place, and must not change or go while it is bound. Bind
 * after t3r_init() and again after t3r_attach(). The analysis does not depend on the head, so another may be bound to
 * one that was kept. T3R_ERR_ARGUMENT (misaligned), T3R_ERR_WEIGHTS, T3R_ERR_STATE (no room for views): what was bound
 * stays. */
t3r_status t3r_bind_head(t3r_runtime *rt, const void *weights, size_t bytes);

/* Why t3r_bind_head() refuses a weight file, as text; NULL when it is sound: then the head is too large for the arena
 * (t3r_head_column_bytes()). */
const char *t3r_weights_error(const void *weights, size_t bytes);

/* The head_column_bytes with which this head works on views of this width, whatever their height: at least 1, 0 when
 * t3r_weights_error() refuses the file or the width is not 1..T3R_MAX_SIDE. The default holds nano, small and base with
 * 8-bit activations; every arena holds heads that need no more than two bytes a pixel. */
uint32_t t3r_head_column_bytes(const void *weights, size_t bytes, uint32_t width);

/* The CRC-32 of the head bound last, 0 when none was: a copied arena remembers it, and so which file to bind again. */
uint32_t t3r_head_crc(const t3r_runtime *rt);

/* Takes the next context view: to planes, resized to the working size, undistorted. The camera belongs to the frame's
 * own pixel grid and must also be in range after resizing. On an error no view is added; an analysis that was kept is
 * gone. T3R_ERR_FRAME, T3R_ERR_CAMERA (also when more than half of the picture lies beyond what the lens can show),
 * T3R_ERR_NO_DEPTH (no plane, or not one measurement in it; with T3R_DEPTH_STEREO the frame's depth is ignored, and
 * pixels with r = g = b = 0 show nothing), T3R_ERR_STATE (no room, or there is a scene: t3r_reset()). */
t3r_status t3r_add_view(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera);

/* Forgets views, analysis and scene; keeps the configuration. Needed before t3r_add_view() once there is a scene. */
t3r_status t3r_reset(t3r_runtime *rt);

/* From the views added so far to exactly min(gaussians, valid points) Gaussians. T3R_ERR_CAMERA when a view stands more
 * than 1,024 scene units from the first; T3R_ERR_STATE: no views (of stereo, fewer than two), the learned head without
 * weights, or the allocation `given`, whose importance comes with t3r_reconstruct_given(); T3R_ERR_STEREO: no two views
 * can be matched, t3r_stereo_pair() says why, the views stay; T3R_ERR_CANCELLED: no scene then, the views stay. */
t3r_status t3r_reconstruct(t3r_runtime *rt, t3r_scene *scene);

/* What the analysis found for context view `view` with T3R_DEPTH_STEREO, also after T3R_ERR_STEREO: T3R_PAIR_OK, and
 * the view that most of its depth came from; or why the pair with the most to hope for was refused. Such a view has no
 * depth and adds no points. *partner is `view` where there is none: by sensor, out of range, before an analysis. */
t3r_pair t3r_stereo_pair(const t3r_runtime *rt, uint32_t view, uint32_t *partner);

/* Another budget for the pair analysed last, without analysing again; needs keep_analysis. A later t3r_reconstruct()
 * goes on with it. T3R_ERR_CANCELLED: no scene then, the settings are as before, the analysis stays. */
t3r_status t3r_rebudget(t3r_runtime *rt, uint32_t gaussians, t3r_scene *scene);

/* Another allocation and head as well as budget, likewise. T3R_ERR_STATE: no analysis was kept, or the learned head
 * without weights, or the allocation `given`. */
t3r_status t3r_reallocate(t3r_runtime *rt, uint32_t gaussians, t3r_allocation allocation, t3r_head head,
                          t3r_scene *scene);

/* The same two by an importance that the caller gives: of all points with depth exactly min(gaussians, valid points) of
 * the highest importance are retained, of equal ones the first in the order of views and rows; doubtful points and
 * surfaces seen twice count as any others. importance[v] is the plane of context view v at the working size, 0..65535 a
 * pixel, aligned for its type, rows `stride_bytes` apart (even, at least 2 x width); the planes are read during the
 * call only. Heads are told the share of points retained about each pixel. The configuration's allocation becomes
 * T3R_ALLOCATE_GIVEN: without importance t3r_reconstruct(), t3r_rebudget() and t3r_reallocate() refuse it with
 * T3R_ERR_STATE, another allocation comes with t3r_reallocate(). Otherwise as t3r_reconstruct() and t3r_rebudget(),
 * also when cancelled; on any error the settings are as before. */
t3r_status t3r_reconstruct_given(t3r_runtime *rt, const uint16_t *const importance[], uint32_t stride_bytes,
                                 t3r_scene *scene);
t3r_status t3r_rebudget_given(t3r_runtime *rt, uint32_t gaussians, const uint16_t *const importance[],
                              uint32_t stride_bytes, t3r_scene *scene);

/* No more than a scene needs: of at most the configuration's Gaussians (`most`) so few that the loss, in PSNR of views
 * between the context's, against a scene of all points is predicted to stay below max_loss_q8 (dB, Q8,
 * 1..T3R_MAX_LOSS_Q8; 128 = 0.5 dB). Predicted from what two trial scenes, of 1/100 and 1/50 of the points, miss in the
 * context views and from how far these disagree among themselves (SPEC.md, "Budget within a loss"); single views are
 * measured by what they miss alone. It takes the time of two builds and more, hashes the trials' stages too, and needs
 * keep_analysis and refinements: T3R_ERR_STATE without. At least 1/400 of the points are kept. The configuration's
 * budget becomes the one chosen. Otherwise as t3r_reconstruct() and t3r_rebudget(); on any error the settings are as
 * before. */
t3r_status t3r_reconstruct_within(t3r_runtime *rt, uint32_t max_loss_q8, t3r_scene *scene);
t3r_status t3r_rebudget_within(t3r_runtime *rt, uint32_t most, uint32_t max_loss_q8, t3r_scene *scene);

/* What a keyframe did to the map of a stream. */
typedef struct t3r_stream_report {
    uint32_t keyframes; /* taken so far, this one too */
    uint32_t gaussians; /* in the map, at most the configuration's */
    uint32_t added;
    uint32_t removed; /* of those there were: contradicted by the keyframe, or replaced by what it sees far finer */
    uint32_t crowded; /* of those there were: dropped for lack of room */
    uint32_t points;  /* pixels with a depth, filled ones too */
    uint32_t shown;   /* of these, those that the map showed already */
} t3r_stream_report;

/* Streams (t3r_config.stream): takes the next keyframe of a moving camera into the map, the scene in the arena, which
 * holds at most the configuration's `gaussians` over any number of keyframes, in bounded time. Pixels that the map
 * shows already add nothing; the others compete with the Gaussians there are by one score, texture density against blue
 * noise (allocations by SuperClusters count as `pixel`, for the score is to mean the same in every keyframe); who stays
 * grows over the gaps, and refinement on the last `views` keyframes corrects what these see as finely as the Gaussian's
 * own. The map's scale is the first keyframe's; its origin follows the camera by whole scene units, and what falls more
 * than 1,024 scene units behind is forgotten. Which frames are keyframes is the caller's choice. A Gaussian's `view` is
 * its keyframe's number modulo `views`. t3r_render(), t3r_get_scene() and t3r_reset(), which begins anew, work in
 * between; `report` may be NULL and is all 0 unless the keyframe was taken. T3R_ERR_STATE: not an arena for streams,
 * the learned head without weights, or the allocation `given`; T3R_ERR_FRAME; T3R_ERR_CAMERA, also more than 1,024
 * scene units from the origin: all as before. T3R_ERR_NO_DEPTH, a lens that shows too little, T3R_ERR_CANCELLED: the
 * keyframe adds nothing and is not among those that refinement looks at, nor is the one of `views` keyframes ago, and
 * Gaussians that it contradicts may be gone. T3R_ERR_CANCELLED during refinement: it is taken, passes are missing. The
 * map stays valid and within its cap whatever happens. */
t3r_status t3r_stream_keyframe(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                               t3r_stream_report *report);

/* How much a picture of width x height by this camera (its distortion is ignored) would have in common with the newest
 * keyframe, Q8, 0..256: the share of that one's points that it would show, or of an 8 x 8 grid over the picture that
 * they fall on, against what they fall on in their own, whichever is less. For choosing keyframes: when it sinks below
 * some 70 %, say, it is time. T3R_ERR_STATE before the first keyframe, T3R_ERR_CAMERA where t3r_stream_keyframe() has
 * it. */
t3r_status t3r_stream_overlap(const t3r_runtime *rt, const t3r_camera *camera, uint32_t width, uint32_t height,
                              uint32_t *overlap_q8);

/* The scene in the arena, after t3r_attach() say. T3R_ERR_STATE when there is none. */
t3r_status t3r_get_scene(const t3r_runtime *rt, t3r_scene *scene);

/* Starts an empty scene in the given frame (exponent -24..24, |origin| < 2^62) and forgets the views; appends to the
 * scene there is. For scenes that come from files: every field of the Gaussian is checked, |position_q20| <= 2^30. */
t3r_status t3r_scene_begin(t3r_runtime *rt, const t3r_scene_frame *frame);
t3r_status t3r_scene_append(t3r_runtime *rt, const t3r_gaussian *gaussian);

/* Draws the scene in the arena as seen by the camera (its distortion is ignored: targets are pinhole). Without
 * keep_analysis the views are forgotten: their planes are where the raster works. T3R_ERR_CAMERA when the camera stands
 * more than 1,024 scene units from the origin; T3R_ERR_CANCELLED leaves the target part drawn. The target's depth and
 * alpha must be aligned for their types. */
t3r_status t3r_render(t3r_runtime *rt, const t3r_camera *camera, const t3r_target *target);

/* Passes over the scene that the last t3r_render() took: 1 when the arena had room for all. */
uint32_t t3r_render_passes(const t3r_runtime *rt);

/* The image stage alone, as t3r_add_view() applies it: any frame to 8-bit RGB and Z16 depth of the working
 * size of `rt`, undistorted, into the caller's memory; depth and depth_out may be NULL. For import and
 * for reference pictures. *undistorted gets the camera of the result. T3R_ERR_STATE unless the runtime is empty. */
t3r_status t3r_develop(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint8_t *rgb_out,
                       uint16_t *depth_out, t3r_camera *undistorted);

/* A short English sentence for a status; never NULL. */
const char *t3r_error_text(t3r_status status);
/* Stable lower-case names, as the command line and the tables spell them; NULL when out of range. */
const char *t3r_stage_name(t3r_stage stage);
const char *t3r_allocation_name(t3r_allocation allocation);
const char *t3r_head_name(t3r_head head);
const char *t3r_depth_name(t3r_depth depth);
const char *t3r_wavelet_name(t3r_wavelet wavelet);
const char *t3r_pixel_format_name(t3r_pixel_format format);
/* Whether two views can be matched, and why not, as text for people; never NULL. */
const char *t3r_pair_text(t3r_pair pair);

#ifdef __cplusplus
}
#endif
#endif
