/* SPDX-License-Identifier: Apache-2.0 */
/* The arena, at compile time: every buffer's bytes, first and last stage, and the sums that follow.
 *
 * t3r_plan() and t3r_init() read the same table (runtime/layout/arena.c), so a static array sized by
 * T3R_ARENA_BYTES() and the layout inside it cannot drift apart. */
#ifndef TRIM3R_ARENA_H
#define TRIM3R_ARENA_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r_features.h"

#define T3R_ARENA_ALIGN 64

/* Stages as plain numbers, usable in constant expressions; t3r_stage gives them a type. */
#define T3R_AT_IMAGE 0
#define T3R_AT_DEPTH 1
#define T3R_AT_POINTMAP 2
#define T3R_AT_WAVELET 3
#define T3R_AT_SUPERCLUSTERS 4
#define T3R_AT_BUDGET 5
#define T3R_AT_HEAD 6
#define T3R_AT_REFINE 7
#define T3R_AT_RASTER 8
#define T3R_AT_COUNT 9

/* Defaults of t3r_default_config() that an arena's bytes depend on. */
/* Default of t3r_config.clusters: one for 256 points of all views, at most 32. */
#define T3R_CLUSTERS_OF_POINTS(points) ((points) < 512 ? 1 : (points) < 32 * 256 ? (points) / 256 : 32)
/* Most passes of refinement where their number is fitted (t3r_config.fit_passes). */
#define T3R_DEFAULT_REFINE (!T3R_FEATURE_REFINEMENT ? 0 : T3R_FEATURE_LOSS ? 8 : 4)

#define T3R_UP_(bytes) (((size_t)(bytes) + (T3R_ARENA_ALIGN - 1)) / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN)
#define T3R_MAX_(a, b) ((a) > (b) ? (a) : (b))

/* Sizes of the records in the arena; runtime/layout/arena.c asserts each against its struct. */
#define T3R_HEADER_BYTES 4096
#define T3R_GAUSSIAN_BYTES 44
#define T3R_SPLAT_BYTES 40
#define T3R_ORDER_BYTES 16       /* two keys and two indices a Gaussian: the radix sort's two sides */
#define T3R_SORT_BYTES 4096      /* four histograms of 256 counts */
#define T3R_CLUSTER_BYTES 56     /* centre and statistics of a SuperCluster */
#define T3R_GROUP_COUNT_BYTES 64 /* what the budget counts of a SuperCluster */
#define T3R_RATIO_BINS 512       /* of a histogram of exposure */
/* Work of the learned head: rows of activations by the column (t3r_config.head_column_bytes; the default holds the
 * heads tiny and small with 8-bit activations at any width), and the activations under its kernels. */
#define T3R_HEAD_COLUMN_BYTES 432
#define T3R_HEAD_KERNEL_BYTES 4096
#define T3R_CORRECTION_BYTES 20       /* what refinement will change in a Gaussian */
#define T3R_REFINE_SUMS_BYTES 112     /* what refinement sums over a Gaussian's pixels */
#define T3R_WANTED_BYTES 4096         /* a tile that refinement compares with its view */
#define T3R_REMEMBERED_HEAD_BYTES 128 /* before the pixels of a remembered keyframe: its camera and gains */
#define T3R_MAP_RECORD_BYTES 12       /* what a stream notes about a Gaussian of its map */
#define T3R_MAP_DISC_BYTES 16         /* the surface around it in a keyframe */
#define T3R_TILE_SIDE 16
#define T3R_GRID_STEP 8 /* undistortion grid, pixels */

/* The K-means' work for any number of points: the centres in whole groups; then, in the same bytes, first the sample,
 * 16 points a centre, later each centre's twelve neighbours, sums and weight. A single SuperCluster needs none. */
#define T3R_CENTRE_ROOM_(clusters) (((size_t)(clusters) + 15) / 16 * 16)
#define T3R_SAMPLE_ROOM_(clusters) ((clusters) < 160 ? (size_t)(clusters)*16 : (size_t)2560)
#define T3R_CLUSTER_SUMS_(clusters) (T3R_UP_((size_t)(clusters)*48) + T3R_UP_((size_t)(clusters)*4))
#define T3R_CLUSTER_SAMPLE_BYTES_(clusters)                                                                            \
    (T3R_UP_(T3R_SAMPLE_ROOM_(clusters) * 12) + T3R_UP_(T3R_SAMPLE_ROOM_(clusters) * 4))
#define T3R_CLUSTER_MEANS_BYTES_(clusters)                                                                             \
    (T3R_UP_(T3R_CENTRE_ROOM_(clusters) * 24) + T3R_CLUSTER_SUMS_(clusters) + T3R_UP_((size_t)(clusters)*4))
#define T3R_CLUSTER_WORK_BYTES(clusters)                                                                               \
    ((clusters) > 1 ? T3R_UP_(T3R_CENTRE_ROOM_(clusters) * 12) + T3R_UP_(T3R_CENTRE_ROOM_(clusters) * 4) +             \
                          T3R_MAX_(T3R_CLUSTER_SAMPLE_BYTES_(clusters), T3R_CLUSTER_MEANS_BYTES_(clusters))            \
                    : (size_t)0)
/* Sums of each worker except the first. */
#define T3R_CLUSTER_SUMS_BYTES(clusters) ((clusters) > 1 ? T3R_CLUSTER_SUMS_(clusters) : (size_t)0)

#define T3R_PIXELS_(width, height) ((size_t)(width) * (height))
#define T3R_TILES_(width, height)                                                                                      \
    ((((size_t)(width) + T3R_TILE_SIDE - 1) / T3R_TILE_SIDE) * (((size_t)(height) + T3R_TILE_SIDE - 1) / T3R_TILE_SIDE))
#define T3R_GRID_NODES_(width, height) (((size_t)(width) / T3R_GRID_STEP + 2) * ((size_t)(height) / T3R_GRID_STEP + 2))
/* A keyframe that a stream remembers: two bytes a pixel. */
#define T3R_REMEMBERED_BYTES(width, height) (T3R_REMEMBERED_HEAD_BYTES + T3R_UP_(T3R_PIXELS_(width, height) * 2))
/* Resizing accumulates rows, one set for each worker; undistortion reads planes by a grid. */
#define T3R_IMAGE_ROW_BYTES_(width) T3R_UP_((size_t)(width)*24)
#define T3R_IMAGE_WORK_BYTES_(width, height, workers)                                                                  \
    (T3R_UP_(T3R_GRID_NODES_(width, height) * 8) + (workers)*T3R_IMAGE_ROW_BYTES_(width) +                             \
     T3R_UP_(T3R_PIXELS_(width, height) * 2) + T3R_UP_(T3R_PIXELS_(width, height) * 3))
/* The columns of a picture rounded up to 16, a whole pixel of the coarsest level. */
#define T3R_HEAD_COLUMNS_(width) (((size_t)(width) + 15) / 16 * 16)
#define T3R_HEAD_WORK_(width, column_bytes)                                                                            \
    ((column_bytes) > 0 ? T3R_HEAD_COLUMNS_(width) * (column_bytes) + T3R_HEAD_KERNEL_BYTES : (size_t)0)
/* Work of lifting beside its plane: the two halves of a row. Each has T3R_WAVELET_PAD samples before and after it, and
 * its length is rounded up to a multiple of that. The texture rows of all levels, width + 5 samples, take less. */
#define T3R_WAVELET_PAD 8u /* samples: 16 bytes, so that halves stay aligned */
#define T3R_WAVELET_ROW_BYTES(width) (((size_t)(width) + 5 * T3R_WAVELET_PAD) * 2)
#define T3R_WAVELET_WORK_BYTES_(width, height)                                                                         \
    (T3R_UP_(T3R_PIXELS_(width, height) * 2) + T3R_UP_(T3R_WAVELET_ROW_BYTES(width)))

/* Most Gaussians that reach into one worker's tiles from another's; with more, fewer workers draw. */
#define T3R_REFINE_BORDER_(gaussians) (((size_t)(gaussians) + 3) / 4)

/* Stereo: work of one pair of views, with the disparities and paths of the pipeline. */
#define T3R_STEREO_DISPARITIES 128u /* most; the first look finds how many are compared */
#define T3R_STEREO_PATHS 4u
/* The largest side of a rectified plane in planar rectification; other shapes take no more memory. */
#define T3R_RECTIFIED_SIDE(width, height) (((size_t)((width) > (height) ? (width) : (height)) * 5 / 4 + 7) / 8 * 8)
#define T3R_CENSUS_BYTES 3
/* The state of one path over a row: (width + 2) (disparities + 1) + 1 bytes of slots, then width + 2 leasts. */
#define T3R_PATH_STATE_BYTES(width, disparities) (((size_t)(width) + 2) * ((size_t)(disparities) + 2) + 1)
/* Rows of a block: a power of two near the root of the height. */
#define T3R_MATCH_ROWS(height) ((height) <= 128 ? 8u : (height) <= 512 ? 16u : (height) <= 2048 ? 32u : 64u)
#define T3R_MATCH_BLOCKS(height) (((size_t)(height) + T3R_MATCH_ROWS(height) - 1) / T3R_MATCH_ROWS(height))
#define T3R_MATCH_RIGHT(width, disparities) ((size_t)(width) + (disparities)-1)
/* Path states that lead from row to row */
#define T3R_MATCH_STATES(paths) ((paths) == 8 ? 3u : 1u)
/* Regions of fewer pixels than this are speckles. */
#define T3R_MATCH_LEAST_REGION(width, height) ((uint32_t)((size_t)(width) * (height) / 1024 + 1))
/* Bytes of the matching's work, aligned to 4; the second part is what speckles take. */
#define T3R_MATCH_WORK_BYTES(width, height, disparities, paths)                                                        \
    T3R_MAX_(T3R_MATCH_PATH_BYTES_(width, height, disparities, paths),                                                 \
             (size_t)4 * T3R_MATCH_LEAST_REGION(width, height) + T3R_MATCH_RIGHT(width, disparities) * (height))
/* X(type, part, count): parts of the paths' work, with blocks of T3R_MATCH_ROWS(height) rows. */
#define T3R_MATCH_PARTS_(X, width, height, disparities, paths)                                                         \
    X(int16_t, sums, (size_t)(width) * (disparities)*T3R_MATCH_ROWS(height))                                           \
    X(int16_t, winners, T3R_MATCH_RIGHT(width, disparities) * 2)                                                       \
    X(uint8_t, cost, (size_t)(width) * (disparities)*T3R_MATCH_ROWS(height))                                           \
    X(uint8_t, states,                                                                                                 \
      (T3R_MATCH_BLOCKS(height) + 4) * T3R_MATCH_STATES(paths) * T3R_PATH_STATE_BYTES(width, disparities))             \
    X(uint8_t, bits, (size_t)(width)*T3R_CENSUS_BYTES)                                                                 \
    X(uint8_t, mirrored, T3R_MATCH_RIGHT(width, disparities) * T3R_CENSUS_BYTES)                                       \
    X(uint8_t, straight, T3R_MATCH_RIGHT(width, disparities) * T3R_CENSUS_BYTES)                                       \
    X(uint8_t, least, T3R_MATCH_RIGHT(width, disparities))
#define T3R_PART_BYTES_(type, part, count) +T3R_UP_((count) * sizeof(type))
#define T3R_MATCH_PATH_BYTES_(width, height, disparities, paths)                                                       \
    ((size_t)0 T3R_MATCH_PARTS_(T3R_PART_BYTES_, width, height, disparities, paths))
/* Filling by the surroundings: lengths of paths; sums of cells; planes of sources and luma */
#define T3R_SURROUNDINGS_CELLS_ 8u /* along a view's longer side, for the slopes of surfaces */
#define T3R_SURFACE_SUMS_BYTES_ 72
#define T3R_SURROUNDINGS_CELLS_BYTES_                                                                                  \
    T3R_UP_((size_t)T3R_SURROUNDINGS_CELLS_ *T3R_SURROUNDINGS_CELLS_ *T3R_SURFACE_SUMS_BYTES_)
#define T3R_SURROUNDINGS_LENGTHS_(width, height) T3R_UP_(T3R_PIXELS_(width, height) * 2)
#define T3R_SURROUNDINGS_BYTES_(width, height)                                                                         \
    (T3R_SURROUNDINGS_LENGTHS_(width, height) + T3R_SURROUNDINGS_CELLS_BYTES_ +                                        \
     T3R_UP_(T3R_PIXELS_(width, height) * 4) + T3R_UP_(T3R_PIXELS_(width, height)))
/* Comparison of views, or before it the filling of a view; a stream has no filling. */
#define T3R_POINTMAP_WORK_(shape)                                                                                      \
    T3R_MAX_((T3R_VIEW_PIXELS_(shape) + 3 * T3R_RATIO_BINS) * 4,                                                       \
             T3R_FEATURE_COMPARISON && !T3R_STREAMS_(shape)                                                            \
                 ? T3R_SURROUNDINGS_BYTES_(T3R_WIDTH_(shape), T3R_HEIGHT_(shape))                                      \
                 : (size_t)0)
/* Bytes of a pair's work, aligned to 64: two planes' luma, disparities and confidences, and the matching. */
#define T3R_STEREO_LEFT_(width, height) (T3R_RECTIFIED_SIDE(width, height) * T3R_RECTIFIED_SIDE(width, height))
#define T3R_STEREO_RIGHT_(width, height, disparities)                                                                  \
    (T3R_RECTIFIED_SIDE(width, height) * (T3R_RECTIFIED_SIDE(width, height) + (disparities)))
/* Luma, confidences and disparities of one side of so many pixels */
#define T3R_STEREO_SIDE_BYTES_(pixels) (2 * T3R_UP_(pixels) + T3R_UP_((pixels)*2))
#define T3R_STEREO_PLANES_(width, height, disparities)                                                                 \
    (T3R_STEREO_SIDE_BYTES_(T3R_STEREO_LEFT_(width, height)) +                                                         \
     T3R_STEREO_SIDE_BYTES_(T3R_STEREO_RIGHT_(width, height, disparities)))
/* Work of the matching, at least a view's luma twice */
#define T3R_STEREO_REST_BYTES_(width, height, disparities, paths)                                                      \
    T3R_MAX_(T3R_MATCH_WORK_BYTES(T3R_RECTIFIED_SIDE(width, height), T3R_RECTIFIED_SIDE(width, height), disparities,   \
                                  paths),                                                                              \
             2 * T3R_PIXELS_(width, height))
#define T3R_STEREO_WORK_BYTES(width, height, disparities, paths)                                                       \
    (T3R_STEREO_PLANES_(width, height, disparities) +                                                                  \
     T3R_UP_(T3R_STEREO_REST_BYTES_(width, height, disparities, paths)))
/* Depth and confidence of two views from one pair, where a view is in several pairs */
#define T3R_STEREO_PAIR_BYTES_(width, height)                                                                          \
    (2 * (T3R_UP_(T3R_PIXELS_(width, height) * 2) + T3R_UP_(T3R_PIXELS_(width, height))))
#define T3R_STEREO_BYTES_(width, height, views, stereo)                                                                \
    ((stereo) != 0 && (views) > 1 ? T3R_STEREO_WORK_BYTES(width, height, T3R_STEREO_DISPARITIES, T3R_STEREO_PATHS) +   \
                                        ((views) > 2 ? T3R_STEREO_PAIR_BYTES_(width, height) : (size_t)0)              \
                                  : (size_t)0)

/* --- the shape of an arena: what its bytes depend on ---------------------------------------------------------------
 *
 * Fourteen numbers in parentheses, handed on as one argument and read by name, as T3R_VIEWS_(shape): a constant
 * expression cannot read a struct. `gaussians` is max_gaussians of t3r_config, and `stereo` is 1 where depth is made by
 * stereo, 0 where it comes from a sensor. `keep` is 0 where the analysis ends with the build, 1 where it outlives it,
 * and T3R_KEEP_MAP for a stream: its map and keyframes outlive everything, and one keyframe is analysed at a time. The
 * others are the fields of t3r_config with their names. */
#define T3R_KEEP_MAP 2
#define T3R_SHAPE_(width, height, views, gaussians, clusters, render_width, render_height, head_column_bytes, keep,    \
                   refine, stereo, workers, warm, remember)                                                            \
    (width, height, views, gaussians, clusters, render_width, render_height, head_column_bytes, keep, refine, stereo,  \
     workers, warm, remember)
#define T3R_WIDTH_(shape) T3R_SHAPE_WIDTH_ shape
#define T3R_HEIGHT_(shape) T3R_SHAPE_HEIGHT_ shape
#define T3R_VIEWS_(shape) T3R_SHAPE_VIEWS_ shape
#define T3R_GAUSSIANS_(shape) T3R_SHAPE_GAUSSIANS_ shape
#define T3R_CLUSTERS_(shape) T3R_SHAPE_CLUSTERS_ shape
#define T3R_RENDER_WIDTH_(shape) T3R_SHAPE_RENDER_WIDTH_ shape
#define T3R_RENDER_HEIGHT_(shape) T3R_SHAPE_RENDER_HEIGHT_ shape
#define T3R_COLUMN_BYTES_(shape) T3R_SHAPE_COLUMN_BYTES_ shape
#define T3R_KEEP_(shape) T3R_SHAPE_KEEP_ shape
#define T3R_REFINE_(shape) T3R_SHAPE_REFINE_ shape
#define T3R_STEREO_(shape) T3R_SHAPE_STEREO_ shape
#define T3R_WORKERS_(shape) T3R_SHAPE_WORKERS_ shape
#define T3R_WARM_(shape) T3R_SHAPE_WARM_ shape
#define T3R_REMEMBER_(shape) T3R_SHAPE_REMEMBER_ shape
#define T3R_SHAPE_WIDTH_(width, ...) ((size_t)(width))
#define T3R_SHAPE_HEIGHT_(a, height, ...) ((size_t)(height))
#define T3R_SHAPE_VIEWS_(a, b, views, ...) ((size_t)(views))
#define T3R_SHAPE_GAUSSIANS_(a, b, c, gaussians, ...) ((size_t)(gaussians))
#define T3R_SHAPE_CLUSTERS_(a, b, c, d, clusters, ...) ((size_t)(clusters))
#define T3R_SHAPE_RENDER_WIDTH_(a, b, c, d, e, render_width, ...) ((size_t)(render_width))
#define T3R_SHAPE_RENDER_HEIGHT_(a, b, c, d, e, f, render_height, ...) ((size_t)(render_height))
#define T3R_SHAPE_COLUMN_BYTES_(a, b, c, d, e, f, g, head_column_bytes, ...) ((size_t)(head_column_bytes))
#define T3R_SHAPE_KEEP_(a, b, c, d, e, f, g, h, keep, ...) ((size_t)(keep))
#define T3R_SHAPE_REFINE_(a, b, c, d, e, f, g, h, i, refine, ...) ((size_t)(refine))
#define T3R_SHAPE_STEREO_(a, b, c, d, e, f, g, h, i, j, stereo, ...) ((size_t)(stereo))
#define T3R_SHAPE_WORKERS_(a, b, c, d, e, f, g, h, i, j, k, workers, ...) ((size_t)(workers))
#define T3R_SHAPE_WARM_(a, b, c, d, e, f, g, h, i, j, k, l, warm, ...) ((size_t)(warm))
#define T3R_SHAPE_REMEMBER_(a, b, c, d, e, f, g, h, i, j, k, l, m, remember) ((size_t)(remember))

/* 1 or 0 */
#define T3R_BUILDS_(shape) (T3R_VIEWS_(shape) > 0 ? (size_t)1 : (size_t)0)
#define T3R_STREAMS_(shape) (T3R_KEEP_(shape) == T3R_KEEP_MAP ? (size_t)1 : (size_t)0)
#define T3R_REFINES_(shape) (T3R_VIEWS_(shape) > 0 && T3R_REFINE_(shape) > 0 ? (size_t)1 : (size_t)0)
/* 1 if planes outlive a build for the next one; a stream keeps its map in any case. */
#define T3R_FOLLOWS_(shape)                                                                                            \
    (T3R_VIEWS_(shape) > 0 && T3R_KEEP_(shape) != T3R_KEEP_MAP && T3R_WARM_(shape) != 0 ? (size_t)1 : (size_t)0)

#define T3R_OTHER_WORKERS_(shape) (T3R_WORKERS_(shape) - 1) /* all but the first */
#define T3R_VIEW_PIXELS_(shape) (T3R_WIDTH_(shape) * T3R_HEIGHT_(shape))
#define T3R_ALL_PIXELS_(shape) (T3R_VIEW_PIXELS_(shape) * T3R_VIEWS_(shape))
/* Views analysed at the same time. */
#define T3R_ANALYSED_(shape) (T3R_STREAMS_(shape) ? T3R_BUILDS_(shape) : T3R_VIEWS_(shape))
#define T3R_ANALYSED_PIXELS_(shape) (T3R_VIEW_PIXELS_(shape) * T3R_ANALYSED_(shape))
/* The last stage that needs the planes or the analysis, if a build needs them until `stage`. */
#define T3R_LAST_(shape, stage) (T3R_KEEP_(shape) + T3R_WARM_(shape) > 0 ? T3R_AT_RASTER : (stage))
#define T3R_LAST_ANALYSIS_(shape, stage) (T3R_KEEP_(shape) == 1 ? T3R_AT_RASTER : (stage))

/* Memory for a splat's rows while its tile is drawn: from 129 Gaussians on, the sort's is large enough. */
#define T3R_KEPT_LEAST_BYTES 1028
#define T3R_KEPT_BYTES_(gaussians)                                                                                     \
    ((size_t)(gaussians)*8 < T3R_KEPT_LEAST_BYTES ? T3R_UP_(T3R_KEPT_LEAST_BYTES) : (size_t)0)
/* Refinement works in one buffer: first splats, depth order, tile table and corrections of all Gaussians, then sums of
 * at least one Gaussian in eight and at most all, last tile lists. */
#define T3R_REFINE_FIXED_BYTES_(width, height, gaussians)                                                              \
    (T3R_KEPT_BYTES_(gaussians) + T3R_UP_((gaussians)*T3R_SPLAT_BYTES) +                                               \
     T3R_UP_((gaussians)*T3R_ORDER_BYTES + T3R_SORT_BYTES) + T3R_UP_(T3R_TILES_(width, height) * 4) +                  \
     T3R_UP_((gaussians)*T3R_CORRECTION_BYTES))
#define T3R_REFINE_WORK_(shape, sums, lists)                                                                           \
    (T3R_REFINES_(shape) * (T3R_REFINE_FIXED_BYTES_(T3R_WIDTH_(shape), T3R_HEIGHT_(shape), T3R_GAUSSIANS_(shape)) +    \
                            T3R_UP_((sums)*T3R_REFINE_SUMS_BYTES) + T3R_UP_((lists)*4)))
#define T3R_REFINE_BYTES_(shape) T3R_REFINE_WORK_(shape, (T3R_GAUSSIANS_(shape) + 7) / 8, T3R_GAUSSIANS_(shape))
#define T3R_REFINE_FULL_BYTES_(shape) T3R_REFINE_WORK_(shape, T3R_GAUSSIANS_(shape), T3R_GAUSSIANS_(shape) * 4)

/* Tile lists: at least one entry per Gaussian. With four entries per Gaussian and one per pixel, a pass takes a whole
 * view unless most splats are many tiles wide. */
#define T3R_LISTS_LEAST_BYTES_(shape) (T3R_GAUSSIANS_(shape) * 4)
#define T3R_LISTS_BYTES_(shape)                                                                                        \
    ((T3R_GAUSSIANS_(shape) * 4 + T3R_PIXELS_(T3R_RENDER_WIDTH_(shape), T3R_RENDER_HEIGHT_(shape))) * 4)

/* --- the buffers ------------------------------------------------------------------------------------------------- */

/* X(with, NAME, text, bytes, first stage, last stage), a row a buffer; `with` is handed through to X.
 *
 * Buffers come in the order of their first stage. `scene` and nothing else is laid from the arena's end, so lifetimes
 * nest, and a stage needs the sum over its live buffers. `tile lists` and `refinement work` grow: with more bytes than
 * these least ones they save passes. `head work` may go on up to the scene.
 *
 * The table is in parts, so that a constant expression names a buffer in those stages alone that may need it: buffers
 * that live ALWAYS, FROM a stage on, and IN a single stage. */
#define T3R_BUFFERS_ALWAYS_(X, with, shape)                                                                            \
    X(with, HEADER, "state", T3R_HEADER_BYTES, T3R_AT_IMAGE, T3R_AT_RASTER)                                            \
    X(with, MAP_RECORDS, "map records", T3R_STREAMS_(shape) * T3R_GAUSSIANS_(shape) * T3R_MAP_RECORD_BYTES,            \
      T3R_AT_IMAGE, T3R_AT_RASTER)                                                                                     \
    X(with, REMEMBERED, "remembered",                                                                                  \
      T3R_STREAMS_(shape) * T3R_REMEMBER_(shape) * T3R_REMEMBERED_BYTES(T3R_WIDTH_(shape), T3R_HEIGHT_(shape)),        \
      T3R_AT_IMAGE, T3R_AT_RASTER)                                                                                     \
    X(with, KEPT_TEXTURE, "kept textures", T3R_FOLLOWS_(shape) * T3R_ALL_PIXELS_(shape) * 2, T3R_AT_IMAGE,             \
      T3R_AT_RASTER)                                                                                                   \
    X(with, KEPT_CLUSTERS, "kept SuperClusters", T3R_FOLLOWS_(shape) * T3R_CLUSTERS_(shape) * T3R_CLUSTER_BYTES,       \
      T3R_AT_IMAGE, T3R_AT_RASTER)
#define T3R_BUFFERS_FROM_IMAGE_(X, with, shape)                                                                        \
    X(with, COLOUR, "colour planes", T3R_ALL_PIXELS_(shape) * 3, T3R_AT_IMAGE, T3R_LAST_(shape, T3R_AT_REFINE))        \
    X(with, DEPTH, "depth planes", T3R_ALL_PIXELS_(shape) * 2, T3R_AT_IMAGE, T3R_LAST_(shape, T3R_AT_REFINE))          \
    X(with, VALIDITY, "validity planes", T3R_ALL_PIXELS_(shape), T3R_AT_IMAGE, T3R_LAST_(shape, T3R_AT_REFINE))        \
    X(with, HELD, "planes of the replaced keyframe", T3R_STREAMS_(shape) * T3R_VIEW_PIXELS_(shape) * 6, T3R_AT_IMAGE,  \
      T3R_AT_POINTMAP)
#define T3R_BUFFERS_IN_IMAGE_(X, with, shape)                                                                          \
    X(with, IMAGE_WORK, "undistortion and resize work",                                                                \
      T3R_BUILDS_(shape) * T3R_IMAGE_WORK_BYTES_(T3R_WIDTH_(shape), T3R_HEIGHT_(shape), T3R_WORKERS_(shape)),          \
      T3R_AT_IMAGE, T3R_AT_IMAGE)
#define T3R_BUFFERS_IN_DEPTH_(X, with, shape)                                                                          \
    X(with, STEREO_WORK, "stereo work",                                                                                \
      T3R_STEREO_BYTES_(T3R_WIDTH_(shape), T3R_HEIGHT_(shape), T3R_VIEWS_(shape), T3R_STEREO_(shape)), T3R_AT_DEPTH,   \
      T3R_AT_DEPTH)
#define T3R_BUFFERS_IN_POINTMAP_(X, with, shape)                                                                       \
    X(with, POINTMAP_WORK, "comparison of views", T3R_BUILDS_(shape) * T3R_POINTMAP_WORK_(shape), T3R_AT_POINTMAP,     \
      T3R_AT_POINTMAP)
#define T3R_BUFFERS_FROM_WAVELET_(X, with, shape)                                                                      \
    X(with, TEXTURE, "texture planes", T3R_ANALYSED_PIXELS_(shape) * 2, T3R_AT_WAVELET,                                \
      T3R_LAST_ANALYSIS_(shape, T3R_AT_HEAD))
#define T3R_BUFFERS_IN_WAVELET_(X, with, shape)                                                                        \
    X(with, WAVELET_WORK, "wavelet work",                                                                              \
      T3R_BUILDS_(shape) * T3R_WORKERS_(shape) * T3R_WAVELET_WORK_BYTES_(T3R_WIDTH_(shape), T3R_HEIGHT_(shape)),       \
      T3R_AT_WAVELET, T3R_AT_WAVELET)
#define T3R_BUFFERS_FROM_SUPERCLUSTERS_(X, with, shape)                                                                \
    X(with, LABELS, "SuperCluster labels", T3R_ANALYSED_PIXELS_(shape), T3R_AT_SUPERCLUSTERS,                          \
      T3R_LAST_ANALYSIS_(shape, T3R_AT_HEAD))                                                                          \
    X(with, CLUSTERS, "SuperClusters", T3R_BUILDS_(shape) * (T3R_CLUSTERS_(shape) + 1) * T3R_CLUSTER_BYTES,            \
      T3R_AT_SUPERCLUSTERS, T3R_LAST_ANALYSIS_(shape, T3R_AT_HEAD))
#define T3R_BUFFERS_IN_SUPERCLUSTERS_(X, with, shape)                                                                  \
    X(with, CLUSTER_WORK, "K-means work", T3R_BUILDS_(shape) * T3R_CLUSTER_WORK_BYTES(T3R_CLUSTERS_(shape)),           \
      T3R_AT_SUPERCLUSTERS, T3R_AT_SUPERCLUSTERS)                                                                      \
    X(with, CLUSTER_SUMS, "workers' K-means sums",                                                                     \
      T3R_BUILDS_(shape) * T3R_OTHER_WORKERS_(shape) * T3R_CLUSTER_SUMS_BYTES(T3R_CLUSTERS_(shape)),                   \
      T3R_AT_SUPERCLUSTERS, T3R_AT_SUPERCLUSTERS)
#define T3R_BUFFERS_FROM_BUDGET_(X, with, shape)                                                                       \
    X(with, MASK, "masks", (T3R_VIEW_PIXELS_(shape) + 31) / 32 * T3R_ANALYSED_(shape) * 4, T3R_AT_BUDGET,              \
      T3R_LAST_ANALYSIS_(shape, T3R_AT_HEAD))                                                                          \
    X(with, KEYS, "budget keys", T3R_ANALYSED_PIXELS_(shape) * 2, T3R_AT_BUDGET,                                       \
      T3R_STREAMS_(shape) ? T3R_AT_HEAD : T3R_AT_BUDGET)
#define T3R_BUFFERS_IN_BUDGET_(X, with, shape)                                                                         \
    X(with, BUDGET_WORK, "counts by SuperCluster",                                                                     \
      T3R_BUILDS_(shape) * T3R_WORKERS_(shape) * (T3R_CLUSTERS_(shape) + 1) * T3R_GROUP_COUNT_BYTES, T3R_AT_BUDGET,    \
      T3R_AT_BUDGET)                                                                                                   \
    X(with, MAP_DENSITY, "density of the map", T3R_STREAMS_(shape) * T3R_VIEW_PIXELS_(shape) * 4, T3R_AT_BUDGET,       \
      T3R_AT_BUDGET)                                                                                                   \
    X(with, MAP_DISCS, "surfaces of the map", T3R_STREAMS_(shape) * T3R_GAUSSIANS_(shape) * T3R_MAP_DISC_BYTES,        \
      T3R_AT_BUDGET, T3R_AT_BUDGET)
#define T3R_BUFFERS_IN_HEAD_(X, with, shape)                                                                           \
    X(with, HEAD_WORK, "head work",                                                                                    \
      T3R_BUILDS_(shape) * T3R_WORKERS_(shape) * T3R_UP_(T3R_HEAD_WORK_(T3R_WIDTH_(shape), T3R_COLUMN_BYTES_(shape))), \
      T3R_AT_HEAD, T3R_AT_HEAD)
#define T3R_BUFFERS_IN_REFINE_(X, with, shape)                                                                         \
    X(with, BORDER_SUMS, "sums across workers' borders",                                                               \
      T3R_REFINES_(shape) * T3R_OTHER_WORKERS_(shape) * T3R_REFINE_BORDER_(T3R_GAUSSIANS_(shape)) *                    \
          (T3R_REFINE_SUMS_BYTES + 4),                                                                                 \
      T3R_AT_REFINE, T3R_AT_REFINE)                                                                                    \
    X(with, WANTED, "workers' compared tiles", T3R_REFINES_(shape) * T3R_OTHER_WORKERS_(shape) * T3R_WANTED_BYTES,     \
      T3R_AT_REFINE, T3R_AT_REFINE)                                                                                    \
    X(with, REFINE_WORK, "refinement work", T3R_REFINE_BYTES_(shape), T3R_AT_REFINE, T3R_AT_REFINE)
#define T3R_BUFFERS_IN_RASTER_(X, with, shape)                                                                         \
    X(with, SPLATS, "projected splats", T3R_GAUSSIANS_(shape) * T3R_SPLAT_BYTES, T3R_AT_RASTER, T3R_AT_RASTER)         \
    X(with, ORDER, "depth order", T3R_GAUSSIANS_(shape) * T3R_ORDER_BYTES + T3R_SORT_BYTES, T3R_AT_RASTER,             \
      T3R_AT_RASTER)                                                                                                   \
    X(with, TILES, "tile table", T3R_TILES_(T3R_RENDER_WIDTH_(shape), T3R_RENDER_HEIGHT_(shape)) * 4, T3R_AT_RASTER,   \
      T3R_AT_RASTER)                                                                                                   \
    X(with, LISTS, "tile lists", T3R_LISTS_LEAST_BYTES_(shape), T3R_AT_RASTER, T3R_AT_RASTER)
#define T3R_BUFFERS_SCENE_(X, with, shape)                                                                             \
    X(with, SCENE, "scene", T3R_GAUSSIANS_(shape) * T3R_GAUSSIAN_BYTES,                                                \
      T3R_STREAMS_(shape) ? T3R_AT_IMAGE : T3R_AT_HEAD, T3R_AT_RASTER)
#define T3R_BUFFERS(X, with, shape)                                                                                    \
    T3R_BUFFERS_ALWAYS_(X, with, shape)                                                                                \
    T3R_BUFFERS_FROM_IMAGE_(X, with, shape)                                                                            \
    T3R_BUFFERS_IN_IMAGE_(X, with, shape)                                                                              \
    T3R_BUFFERS_IN_DEPTH_(X, with, shape)                                                                              \
    T3R_BUFFERS_IN_POINTMAP_(X, with, shape)                                                                           \
    T3R_BUFFERS_FROM_WAVELET_(X, with, shape)                                                                          \
    T3R_BUFFERS_IN_WAVELET_(X, with, shape)                                                                            \
    T3R_BUFFERS_FROM_SUPERCLUSTERS_(X, with, shape)                                                                    \
    T3R_BUFFERS_IN_SUPERCLUSTERS_(X, with, shape)                                                                      \
    T3R_BUFFERS_FROM_BUDGET_(X, with, shape)                                                                           \
    T3R_BUFFERS_IN_BUDGET_(X, with, shape)                                                                             \
    T3R_BUFFERS_IN_HEAD_(X, with, shape)                                                                               \
    T3R_BUFFERS_IN_REFINE_(X, with, shape)                                                                             \
    T3R_BUFFERS_IN_RASTER_(X, with, shape)                                                                             \
    T3R_BUFFERS_SCENE_(X, with, shape)

#define T3R_NAME_(with, NAME, text, bytes, first, last) T3R_BUFFER_##NAME,
enum t3r_buffer { T3R_BUFFERS(T3R_NAME_, 0, 0) T3R_BUFFER_COUNT };

/* --- the sums ---------------------------------------------------------------------------------------------------- */

#define T3R_LIVE_(stage, NAME, text, bytes, first, last)                                                               \
    +((first) <= (stage) && (stage) <= (last) ? T3R_UP_(bytes) : (size_t)0)
/* Bytes of those buffers that may have begun by a stage and may outlive one */
#define T3R_LASTING_IMAGE_(stage, shape)                                                                               \
    T3R_BUFFERS_FROM_IMAGE_(T3R_LIVE_, stage, shape) T3R_BUFFERS_SCENE_(T3R_LIVE_, stage, shape)
#define T3R_LASTING_DEPTH_(stage, shape) T3R_LASTING_IMAGE_(stage, shape)
#define T3R_LASTING_POINTMAP_(stage, shape) T3R_LASTING_IMAGE_(stage, shape)
#define T3R_LASTING_WAVELET_(stage, shape)                                                                             \
    T3R_LASTING_IMAGE_(stage, shape) T3R_BUFFERS_FROM_WAVELET_(T3R_LIVE_, stage, shape)
#define T3R_LASTING_SUPERCLUSTERS_(stage, shape)                                                                       \
    T3R_LASTING_WAVELET_(stage, shape) T3R_BUFFERS_FROM_SUPERCLUSTERS_(T3R_LIVE_, stage, shape)
#define T3R_LASTING_BUDGET_(stage, shape)                                                                              \
    T3R_LASTING_SUPERCLUSTERS_(stage, shape) T3R_BUFFERS_FROM_BUDGET_(T3R_LIVE_, stage, shape)
#define T3R_LASTING_HEAD_(stage, shape) T3R_LASTING_BUDGET_(stage, shape)
#define T3R_LASTING_REFINE_(stage, shape) T3R_LASTING_BUDGET_(stage, shape)
#define T3R_LASTING_RASTER_(stage, shape) T3R_LASTING_BUDGET_(stage, shape)
/* Bytes of a stage beside those buffers that live always */
#define T3R_STAGE_BYTES_(STAGE, shape)                                                                                 \
    (0 T3R_LASTING_##STAGE##_(T3R_AT_##STAGE, shape) T3R_BUFFERS_IN_##STAGE##_(T3R_LIVE_, T3R_AT_##STAGE, shape))
/* Every argument is repeated 2^depth times, so the tree is flat, and long ones stand near its root. */
#define T3R_MOST_(a, b, c, d) T3R_MAX_(T3R_MAX_(a, b), T3R_MAX_(c, d))
#define T3R_MOST_OF_STAGES_(shape, more_refine, more_raster)                                                           \
    (0 T3R_BUFFERS_ALWAYS_(T3R_LIVE_, T3R_AT_IMAGE, shape) +                                                           \
     T3R_MAX_(T3R_MAX_(T3R_STAGE_BYTES_(DEPTH, shape),                                                                 \
                       T3R_MOST_(T3R_STAGE_BYTES_(IMAGE, shape), T3R_STAGE_BYTES_(POINTMAP, shape),                    \
                                 T3R_STAGE_BYTES_(WAVELET, shape), T3R_STAGE_BYTES_(HEAD, shape))),                    \
              T3R_MOST_(T3R_STAGE_BYTES_(SUPERCLUSTERS, shape), T3R_STAGE_BYTES_(BUDGET, shape),                       \
                        T3R_STAGE_BYTES_(REFINE, shape) + (more_refine),                                               \
                        T3R_STAGE_BYTES_(RASTER, shape) + (more_raster))))
#define T3R_MIN_BYTES_(shape) T3R_MOST_OF_STAGES_(shape, 0, 0)
#define T3R_FULL_BYTES_(shape)                                                                                         \
    T3R_MOST_OF_STAGES_(shape, T3R_UP_(T3R_REFINE_FULL_BYTES_(shape)) - T3R_UP_(T3R_REFINE_BYTES_(shape)),             \
                        T3R_UP_(T3R_LISTS_BYTES_(shape)) - T3R_UP_(T3R_LISTS_LEAST_BYTES_(shape)))

/* The default configuration: targets of the working size, the analysis not kept, one worker. */
#define T3R_DEFAULT_SHAPE_(width, height, views, gaussians, keep, stereo, warm)                                        \
    T3R_SHAPE_(width, height, views, gaussians,                                                                        \
               (keep) == T3R_KEEP_MAP ? 1 : T3R_CLUSTERS_OF_POINTS(T3R_PIXELS_(width, height) * (views)), width,       \
               height, T3R_HEAD_COLUMN_BYTES, keep, T3R_DEFAULT_REFINE, stereo, 1, warm, 0)

/* Arena bytes of the default configuration: the minimum, and the size with which a view takes one pass (views of wide
 * splats may take more). */
#define T3R_ARENA_MIN_BYTES(width, height, views, gaussians)                                                           \
    T3R_MIN_BYTES_(T3R_DEFAULT_SHAPE_(width, height, views, gaussians, 0, 0, 0))
#define T3R_ARENA_BYTES(width, height, views, gaussians)                                                               \
    T3R_FULL_BYTES_(T3R_DEFAULT_SHAPE_(width, height, views, gaussians, 0, 0, 0))
/* The same with depth by stereo (t3r_config.depth). */
#define T3R_STEREO_ARENA_MIN_BYTES(width, height, views, gaussians)                                                    \
    T3R_MIN_BYTES_(T3R_DEFAULT_SHAPE_(width, height, views, gaussians, 0, 1, 0))
#define T3R_STEREO_ARENA_BYTES(width, height, views, gaussians)                                                        \
    T3R_FULL_BYTES_(T3R_DEFAULT_SHAPE_(width, height, views, gaussians, 0, 1, 0))
/* The same with builds that follow one another (t3r_config.warm). */
#define T3R_WARM_ARENA_MIN_BYTES(width, height, views, gaussians)                                                      \
    T3R_MIN_BYTES_(T3R_DEFAULT_SHAPE_(width, height, views, gaussians, 0, 0, 1))
#define T3R_WARM_ARENA_BYTES(width, height, views, gaussians)                                                          \
    T3R_FULL_BYTES_(T3R_DEFAULT_SHAPE_(width, height, views, gaussians, 0, 0, 1))
/* The same for a stream (t3r_config.stream) with `views` live keyframes; each remembered one (t3r_config.remember)
 * takes T3R_REMEMBERED_BYTES(width, height) more. */
#define T3R_STREAM_MIN_BYTES(width, height, views, gaussians)                                                          \
    T3R_MIN_BYTES_(T3R_DEFAULT_SHAPE_(width, height, views, gaussians, T3R_KEEP_MAP, 0, 0))
#define T3R_STREAM_BYTES(width, height, views, gaussians)                                                              \
    T3R_FULL_BYTES_(T3R_DEFAULT_SHAPE_(width, height, views, gaussians, T3R_KEEP_MAP, 0, 0))

#endif
