/* The arena, at compile time: every buffer's bytes, first and last stage, and the sums that follow.
 *
 * t3r_plan() and t3r_init() read the same table (runtime/layout/arena.c), so a static array sized by
 * T3R_ARENA_BYTES() and the layout inside it cannot drift apart. */
#ifndef TRIM3R_ARENA_H
#define TRIM3R_ARENA_H

#include <stddef.h>
#include <stdint.h>

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
#define T3R_DEFAULT_CLUSTERS 300
#define T3R_DEFAULT_REFINEMENTS 4

#define T3R_UP_(bytes) (((size_t)(bytes) + (T3R_ARENA_ALIGN - 1)) / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN)
#define T3R_MAX_(a, b) ((a) > (b) ? (a) : (b))

/* Sizes of the records in the arena; runtime/layout/arena.c asserts each against its struct. */
#define T3R_HEADER_BYTES 4096
#define T3R_GAUSSIAN_BYTES 44
#define T3R_SPLAT_BYTES 40
#define T3R_ORDER_BYTES 16           /* two keys and two indices a Gaussian: the radix sort's two sides */
#define T3R_SORT_BYTES 4096          /* four histograms of 256 counts */
#define T3R_CLUSTER_BYTES 56         /* centre and statistics of a SuperCluster */
#define T3R_CLUSTER_WORK_BYTES 49216 /* the K-means' sample and sums, whatever the number of points */
#define T3R_GROUP_COUNTS_BYTES 4096  /* what the budget counts by SuperCluster */
#define T3R_CLUSTER_SUMS_BYTES 26624 /* sums of each worker but the first */
/* Work of the learned head: rows of activations by the column (t3r_config.head_column_bytes; the default holds the
 * heads nano, small and base with 8-bit activations at any width), and the activations under its kernels. */
#define T3R_HEAD_COLUMN_BYTES 704
#define T3R_HEAD_KERNEL_BYTES 4096
#define T3R_CORRECTION_BYTES 20   /* what refinement will change in a Gaussian */
#define T3R_REFINE_SUMS_BYTES 104 /* what refinement sums over a Gaussian's pixels */
#define T3R_WANTED_BYTES 4096     /* a tile that refinement compares with its view */
#define T3R_MAP_RECORD_BYTES 12   /* what a stream notes about a Gaussian of its map */
#define T3R_TILE_SIDE 16
#define T3R_GRID_STEP 8 /* undistortion grid, pixels */

#define T3R_PIXELS_(w, h) ((size_t)(w) * (h))
#define T3R_TILES_(w, h)                                                                                               \
    ((((size_t)(w) + T3R_TILE_SIDE - 1) / T3R_TILE_SIDE) * (((size_t)(h) + T3R_TILE_SIDE - 1) / T3R_TILE_SIDE))
#define T3R_GRID_NODES_(w, h) (((size_t)(w) / T3R_GRID_STEP + 2) * ((size_t)(h) / T3R_GRID_STEP + 2))
/* Resizing sums rows of each worker; undistortion reads planes by a grid. */
#define T3R_IMAGE_ROW_BYTES_(w) T3R_UP_((size_t)(w)*24)
#define T3R_IMAGE_WORK_BYTES_(w, h, wk)                                                                                \
    (T3R_UP_(T3R_GRID_NODES_(w, h) * 8) + (wk)*T3R_IMAGE_ROW_BYTES_(w) + T3R_UP_(T3R_PIXELS_(w, h) * 2) +              \
     T3R_UP_(T3R_PIXELS_(w, h) * 3))
/* Columns of a picture whose coarsest level, 16 pixels wide, is whole */
#define T3R_HEAD_COLUMNS_(w) (((size_t)(w) + 15) / 16 * 16)
#define T3R_HEAD_WORK_(w, h, hc)                                                                                       \
    T3R_MAX_(T3R_PIXELS_(w, h) * 2, (hc) > 0 ? T3R_HEAD_COLUMNS_(w) * (hc) + T3R_HEAD_KERNEL_BYTES : (size_t)0)
/* What lifting needs beside its plane: a row's halves, each with T3R_WAVELET_PAD samples before and behind and rounded
 * up to so many. The texture rows of all levels, width + 5 samples, take less. */
#define T3R_WAVELET_PAD 8u /* samples: 16 bytes, so that halves stay aligned */
#define T3R_WAVELET_ROW_BYTES(width) (((size_t)(width) + 5 * T3R_WAVELET_PAD) * 2)
#define T3R_WAVELET_WORK_BYTES_(w, h) (T3R_UP_(T3R_PIXELS_(w, h) * 2) + T3R_UP_(T3R_WAVELET_ROW_BYTES(w)))
#define T3R_ANY_(v) ((v) > 0 ? (size_t)1 : (size_t)0)

/* Refinement works in one buffer: splats, depth order, tile table and corrections of all Gaussians, then the sums of
 * as many Gaussians as there is room for, at least every eighth, then tile lists. */
#define T3R_REFINE_FIXED_BYTES_(w, h, z)                                                                               \
    (T3R_UP_((size_t)(z)*T3R_SPLAT_BYTES) + T3R_UP_((size_t)(z)*T3R_ORDER_BYTES + T3R_SORT_BYTES) +                    \
     T3R_UP_(T3R_TILES_(w, h) * 4) + T3R_UP_((size_t)(z)*T3R_CORRECTION_BYTES))
#define T3R_REFINE_LEAST_SUMS_(z) (((size_t)(z) + 7) / 8)
/* Gaussians that may reach into one worker's tiles from those of another: where there are more, fewer workers draw. */
#define T3R_REFINE_BORDER_(z) (((size_t)(z) + 3) / 4)
#define T3R_REFINE_BYTES_(w, h, v, z, n)                                                                               \
    (T3R_ANY_(v) * T3R_ANY_(n) *                                                                                       \
     (T3R_REFINE_FIXED_BYTES_(w, h, z) + T3R_UP_(T3R_REFINE_LEAST_SUMS_(z) * T3R_REFINE_SUMS_BYTES) +                  \
      T3R_UP_((size_t)(z)*4)))
#define T3R_REFINE_FULL_BYTES_(w, h, v, z, n)                                                                          \
    (T3R_ANY_(v) * T3R_ANY_(n) *                                                                                       \
     (T3R_REFINE_FIXED_BYTES_(w, h, z) + T3R_UP_((size_t)(z)*T3R_REFINE_SUMS_BYTES) + T3R_UP_((size_t)(z)*16)))

/* Stereo: work of one pair of views, and as many disparities and paths as the pipeline asks for. */
#define T3R_STEREO_DISPARITIES 128u /* most; as many as the first look finds are compared */
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
/* X(type, part, count): what the paths take, rows of T3R_MATCH_ROWS(height) being one block. */
#define T3R_MATCH_PARTS_(X, width, height, disparities, paths)                                                         \
    X(int16_t, sums, (size_t)(width) * (disparities)*T3R_MATCH_ROWS(height))                                           \
    X(int16_t, winners, T3R_MATCH_RIGHT(width, disparities) * 2)                                                       \
    X(uint8_t, cost, (size_t)(width) * (disparities)*T3R_MATCH_ROWS(height))                                           \
    X(uint8_t, states,                                                                                                 \
      (T3R_MATCH_BLOCKS(height) + 4) * T3R_MATCH_STATES(paths) * T3R_PATH_STATE_BYTES(width, disparities))             \
    X(uint8_t, bits, (size_t)(width)*T3R_CENSUS_BYTES)                                                                 \
    X(uint8_t, bits_right, T3R_MATCH_RIGHT(width, disparities) * T3R_CENSUS_BYTES)                                     \
    X(uint8_t, straight, T3R_MATCH_RIGHT(width, disparities) * T3R_CENSUS_BYTES)                                       \
    X(uint8_t, least, T3R_MATCH_RIGHT(width, disparities))
#define T3R_PART_BYTES_(type, part, count) +T3R_UP_((count) * sizeof(type))
#define T3R_MATCH_PATH_BYTES_(width, height, disparities, paths)                                                       \
    ((size_t)0 T3R_MATCH_PARTS_(T3R_PART_BYTES_, width, height, disparities, paths))
/* Bytes of a pair's work, aligned to 64: two planes' luma, disparities and confidences, and the matching. */
#define T3R_STEREO_LEFT_(width, height) (T3R_RECTIFIED_SIDE(width, height) * T3R_RECTIFIED_SIDE(width, height))
#define T3R_STEREO_RIGHT_(width, height, disparities)                                                                  \
    (T3R_RECTIFIED_SIDE(width, height) * (T3R_RECTIFIED_SIDE(width, height) + (disparities)))
/* Luma, confidences and disparities of one side of so many pixels */
#define T3R_STEREO_SIDE_BYTES_(pixels) (2 * T3R_UP_(pixels) + T3R_UP_((pixels)*2))
#define T3R_STEREO_PLANES_(width, height, disparities)                                                                 \
    (T3R_STEREO_SIDE_BYTES_(T3R_STEREO_LEFT_(width, height)) +                                                         \
     T3R_STEREO_SIDE_BYTES_(T3R_STEREO_RIGHT_(width, height, disparities)))
/* What the matching takes, and at least a view's luma twice */
#define T3R_STEREO_REST_BYTES_(width, height, disparities, paths)                                                      \
    T3R_MAX_(T3R_MATCH_WORK_BYTES(T3R_RECTIFIED_SIDE(width, height), T3R_RECTIFIED_SIDE(width, height), disparities,   \
                                  paths),                                                                              \
             2 * T3R_PIXELS_(width, height))
#define T3R_STEREO_WORK_BYTES(width, height, disparities, paths)                                                       \
    (T3R_STEREO_PLANES_(width, height, disparities) +                                                                  \
     T3R_UP_(T3R_STEREO_REST_BYTES_(width, height, disparities, paths)))
/* Depth and confidence of two views from one pair, where a view is in several pairs */
#define T3R_STEREO_PAIR_BYTES_(w, h) (2 * (T3R_UP_(T3R_PIXELS_(w, h) * 2) + T3R_UP_(T3R_PIXELS_(w, h))))
#define T3R_STEREO_BYTES_(w, h, v, s)                                                                                  \
    ((s) != 0 && (v) > 1 ? T3R_STEREO_WORK_BYTES(w, h, T3R_STEREO_DISPARITIES, T3R_STEREO_PATHS) +                     \
                               ((v) > 2 ? T3R_STEREO_PAIR_BYTES_(w, h) : (size_t)0)                                    \
                         : (size_t)0)

/* X(p, NAME, text, bytes, first, last); p is handed through.
 * w x h working size, v views, z Gaussians, k clusters, rw x rh largest target, hc the learned head's bytes a column;
 * keep: the analysis outlives the build, or T3R_KEEP_MAP: a stream, whose map and keyframes outlive everything, one
 * keyframe being analysed at a time; n refinements; s: depth is made by stereo; wk workers. Buffers come in the order
 * of their first stage; `scene` and nothing else is laid from the arena's end, so that lifetimes nest and the sum over
 * the live buffers of a stage is what that stage needs. `tile lists` and `refinement work` grow: more bytes than their
 * minimum save passes. */
#define T3R_KEEP_MAP 2
#define T3R_STREAMS_(keep) ((keep) == T3R_KEEP_MAP)
#define T3R_LAST_(keep, stage) ((keep) ? T3R_AT_RASTER : (stage))
#define T3R_LAST_ANALYSIS_(keep, stage) ((keep) && !T3R_STREAMS_(keep) ? T3R_AT_RASTER : (stage))
#define T3R_ANALYSED_(v, keep) (T3R_STREAMS_(keep) ? T3R_ANY_(v) : (size_t)(v))
#define T3R_BUFFERS(X, p, w, h, v, z, k, rw, rh, hc, keep, n, s, wk)                                                   \
    X(p, HEADER, "state", T3R_HEADER_BYTES, T3R_AT_IMAGE, T3R_AT_RASTER)                                               \
    X(p, MAP_RECORDS, "map records", T3R_STREAMS_(keep) * (size_t)(z)*T3R_MAP_RECORD_BYTES, T3R_AT_IMAGE,              \
      T3R_AT_RASTER)                                                                                                   \
    X(p, COLOUR, "colour planes", T3R_PIXELS_(w, h) * (v)*3, T3R_AT_IMAGE, T3R_LAST_(keep, T3R_AT_REFINE))             \
    X(p, DEPTH, "depth planes", T3R_PIXELS_(w, h) * (v)*2, T3R_AT_IMAGE, T3R_LAST_(keep, T3R_AT_REFINE))               \
    X(p, VALIDITY, "validity planes", T3R_PIXELS_(w, h) * (v), T3R_AT_IMAGE, T3R_LAST_(keep, T3R_AT_REFINE))           \
    X(p, IMAGE_WORK, "undistortion and resize work", T3R_ANY_(v) * T3R_IMAGE_WORK_BYTES_(w, h, wk), T3R_AT_IMAGE,      \
      T3R_AT_IMAGE)                                                                                                    \
    X(p, STEREO_WORK, "stereo work", T3R_STEREO_BYTES_(w, h, v, s), T3R_AT_DEPTH, T3R_AT_DEPTH)                        \
    X(p, POINTMAP_WORK, "comparison of views", T3R_ANY_(v) * T3R_PIXELS_(w, h) * 4, T3R_AT_POINTMAP, T3R_AT_POINTMAP)  \
    X(p, TEXTURE, "texture planes", T3R_PIXELS_(w, h) * T3R_ANALYSED_(v, keep) * 2, T3R_AT_WAVELET,                    \
      T3R_LAST_ANALYSIS_(keep, T3R_AT_HEAD))                                                                           \
    X(p, WAVELET_WORK, "wavelet work", T3R_ANY_(v) * (wk)*T3R_WAVELET_WORK_BYTES_(w, h), T3R_AT_WAVELET,               \
      T3R_AT_WAVELET)                                                                                                  \
    X(p, LABELS, "SuperCluster labels", T3R_PIXELS_(w, h) * T3R_ANALYSED_(v, keep) * 2, T3R_AT_SUPERCLUSTERS,          \
      T3R_LAST_ANALYSIS_(keep, T3R_AT_HEAD))                                                                           \
    X(p, CLUSTERS, "SuperClusters", T3R_ANY_(v) * ((k) + 1) * T3R_CLUSTER_BYTES, T3R_AT_SUPERCLUSTERS,                 \
      T3R_LAST_ANALYSIS_(keep, T3R_AT_HEAD))                                                                           \
    X(p, CLUSTER_WORK, "K-means work", T3R_ANY_(v) * T3R_CLUSTER_WORK_BYTES, T3R_AT_SUPERCLUSTERS,                     \
      T3R_AT_SUPERCLUSTERS)                                                                                            \
    X(p, CLUSTER_SUMS, "workers' K-means sums", T3R_ANY_(v) * ((wk)-1) * T3R_CLUSTER_SUMS_BYTES, T3R_AT_SUPERCLUSTERS, \
      T3R_AT_SUPERCLUSTERS)                                                                                            \
    X(p, MASK, "masks", (T3R_PIXELS_(w, h) + 31) / 32 * T3R_ANALYSED_(v, keep) * 4, T3R_AT_BUDGET,                     \
      T3R_LAST_ANALYSIS_(keep, T3R_AT_HEAD))                                                                           \
    X(p, KEYS, "budget keys", T3R_PIXELS_(w, h) * T3R_ANALYSED_(v, keep) * 2, T3R_AT_BUDGET,                           \
      T3R_STREAMS_(keep) ? T3R_AT_HEAD : T3R_AT_BUDGET)                                                                \
    X(p, BUDGET_WORK, "counts by SuperCluster", T3R_ANY_(v) * (wk)*T3R_GROUP_COUNTS_BYTES, T3R_AT_BUDGET,              \
      T3R_AT_BUDGET)                                                                                                   \
    X(p, HEAD_WORK, "head work", T3R_ANY_(v) * (wk)*T3R_UP_(T3R_HEAD_WORK_(w, h, hc)), T3R_AT_HEAD, T3R_AT_HEAD)       \
    X(p, MAP_VIEW, "map as a keyframe sees it", T3R_STREAMS_(keep) * T3R_PIXELS_(w, h) * 4, T3R_AT_REFINE,             \
      T3R_AT_REFINE)                                                                                                   \
    X(p, BORDER_SUMS, "sums across workers' borders",                                                                  \
      T3R_ANY_(v) * T3R_ANY_((n) + T3R_STREAMS_(keep)) * ((wk)-1) * T3R_REFINE_BORDER_(z) *                            \
          (T3R_REFINE_SUMS_BYTES + 4),                                                                                 \
      T3R_AT_REFINE, T3R_AT_REFINE)                                                                                    \
    X(p, WANTED, "workers' compared tiles",                                                                            \
      T3R_ANY_(v) * T3R_ANY_((n) + T3R_STREAMS_(keep)) * ((wk)-1) * T3R_WANTED_BYTES, T3R_AT_REFINE, T3R_AT_REFINE)    \
    X(p, REFINE_WORK, "refinement work", T3R_REFINE_BYTES_(w, h, v, z, (n) + T3R_STREAMS_(keep)), T3R_AT_REFINE,       \
      T3R_AT_REFINE)                                                                                                   \
    X(p, SPLATS, "projected splats", (size_t)(z)*T3R_SPLAT_BYTES, T3R_AT_RASTER, T3R_AT_RASTER)                        \
    X(p, ORDER, "depth order", (size_t)(z)*T3R_ORDER_BYTES + T3R_SORT_BYTES, T3R_AT_RASTER, T3R_AT_RASTER)             \
    X(p, TILES, "tile table", T3R_TILES_(rw, rh) * 4, T3R_AT_RASTER, T3R_AT_RASTER)                                    \
    X(p, LISTS, "tile lists", (size_t)(z)*4, T3R_AT_RASTER, T3R_AT_RASTER)                                             \
    X(p, SCENE, "scene", (size_t)(z)*T3R_GAUSSIAN_BYTES, T3R_STREAMS_(keep) ? T3R_AT_IMAGE : T3R_AT_HEAD, T3R_AT_RASTER)

#define T3R_NAME_(p, NAME, text, bytes, first, last) T3R_BUFFER_##NAME,
enum t3r_buffer { T3R_BUFFERS(T3R_NAME_, 0, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 1) T3R_BUFFER_COUNT };

/* Tile-list bytes with which a pass takes a whole view, unless most splats are many tiles wide: an entry for four tiles
 * a Gaussian and one a pixel. */
#define T3R_LISTS_BYTES_(z, rw, rh) (((size_t)(z)*4 + T3R_PIXELS_(rw, rh)) * 4)

#define T3R_LIVE_(stage, NAME, text, bytes, first, last)                                                               \
    +((first) <= (stage) && (stage) <= (last) ? T3R_UP_(bytes) : (size_t)0)
#define T3R_STAGE_BYTES_(stage, w, h, v, z, k, rw, rh, hc, keep, n, s, wk)                                             \
    (0 T3R_BUFFERS(T3R_LIVE_, stage, w, h, v, z, k, rw, rh, hc, keep, n, s, wk))
/* Every argument is written out 2^depth times, so the tree is kept flat. */
#define T3R_MOST_(a, b, c, d) T3R_MAX_(T3R_MAX_(a, b), T3R_MAX_(c, d))
#define T3R_MOST_OF_STAGES_(w, h, v, z, k, rw, rh, hc, keep, n, s, wk, more_refine, more_raster)                       \
    T3R_MAX_(T3R_MOST_(T3R_STAGE_BYTES_(T3R_AT_IMAGE, w, h, v, z, k, rw, rh, hc, keep, n, s, wk),                      \
                       T3R_STAGE_BYTES_(T3R_AT_DEPTH, w, h, v, z, k, rw, rh, hc, keep, n, s, wk),                      \
                       T3R_STAGE_BYTES_(T3R_AT_WAVELET, w, h, v, z, k, rw, rh, hc, keep, n, s, wk),                    \
                       T3R_STAGE_BYTES_(T3R_AT_SUPERCLUSTERS, w, h, v, z, k, rw, rh, hc, keep, n, s, wk)),             \
             T3R_MOST_(T3R_STAGE_BYTES_(T3R_AT_BUDGET, w, h, v, z, k, rw, rh, hc, keep, n, s, wk),                     \
                       T3R_STAGE_BYTES_(T3R_AT_HEAD, w, h, v, z, k, rw, rh, hc, keep, n, s, wk),                       \
                       T3R_STAGE_BYTES_(T3R_AT_REFINE, w, h, v, z, k, rw, rh, hc, keep, n, s, wk) + (more_refine),     \
                       T3R_STAGE_BYTES_(T3R_AT_RASTER, w, h, v, z, k, rw, rh, hc, keep, n, s, wk) + (more_raster)))
#define T3R_MIN_BYTES_(w, h, v, z, k, rw, rh, hc, keep, n, s, wk)                                                      \
    T3R_MOST_OF_STAGES_(w, h, v, z, k, rw, rh, hc, keep, n, s, wk, 0, 0)
#define T3R_FULL_BYTES_(w, h, v, z, k, rw, rh, hc, keep, n, s, wk)                                                     \
    T3R_MOST_OF_STAGES_(w, h, v, z, k, rw, rh, hc, keep, n, s, wk,                                                     \
                        T3R_UP_(T3R_REFINE_FULL_BYTES_(w, h, v, z, (n) + T3R_STREAMS_(keep))) -                        \
                            T3R_UP_(T3R_REFINE_BYTES_(w, h, v, z, (n) + T3R_STREAMS_(keep))),                          \
                        T3R_UP_(T3R_LISTS_BYTES_(z, rw, rh)) - T3R_UP_((size_t)(z)*4))

/* For the default configuration (targets of the working size, analysis not kept):
 * the smallest arena that works, and the one with which a view takes one pass (views of wide splats may take more). */
#define T3R_ARENA_MIN_BYTES(width, height, views, gaussians)                                                           \
    T3R_MIN_BYTES_(width, height, views, gaussians, T3R_DEFAULT_CLUSTERS, width, height, T3R_HEAD_COLUMN_BYTES, 0,     \
                   T3R_DEFAULT_REFINEMENTS, 0, 1)
#define T3R_ARENA_BYTES(width, height, views, gaussians)                                                               \
    T3R_FULL_BYTES_(width, height, views, gaussians, T3R_DEFAULT_CLUSTERS, width, height, T3R_HEAD_COLUMN_BYTES, 0,    \
                    T3R_DEFAULT_REFINEMENTS, 0, 1)
/* The same with depth by stereo (t3r_config.depth). */
#define T3R_STEREO_ARENA_MIN_BYTES(width, height, views, gaussians)                                                    \
    T3R_MIN_BYTES_(width, height, views, gaussians, T3R_DEFAULT_CLUSTERS, width, height, T3R_HEAD_COLUMN_BYTES, 0,     \
                   T3R_DEFAULT_REFINEMENTS, 1, 1)
#define T3R_STEREO_ARENA_BYTES(width, height, views, gaussians)                                                        \
    T3R_FULL_BYTES_(width, height, views, gaussians, T3R_DEFAULT_CLUSTERS, width, height, T3R_HEAD_COLUMN_BYTES, 0,    \
                    T3R_DEFAULT_REFINEMENTS, 1, 1)

/* Likewise of a stream (t3r_config.stream) with `views` keyframes at hand, otherwise of the default configuration. */
#define T3R_STREAM_MIN_BYTES(width, height, views, gaussians)                                                          \
    T3R_MIN_BYTES_(width, height, views, gaussians, T3R_DEFAULT_CLUSTERS, width, height, T3R_HEAD_COLUMN_BYTES,        \
                   T3R_KEEP_MAP, T3R_DEFAULT_REFINEMENTS, 0, 1)
#define T3R_STREAM_BYTES(width, height, views, gaussians)                                                              \
    T3R_FULL_BYTES_(width, height, views, gaussians, T3R_DEFAULT_CLUSTERS, width, height, T3R_HEAD_COLUMN_BYTES,       \
                    T3R_KEEP_MAP, T3R_DEFAULT_REFINEMENTS, 0, 1)

#endif
