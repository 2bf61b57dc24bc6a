/* SPDX-License-Identifier: Apache-2.0 */
/* The work of a build, counted before anything runs, and what it takes at some prices. */
#ifndef TRIM3R_TOOLS_WORK_H
#define TRIM3R_TOOLS_WORK_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

/* X(NAME, name, stage): the kinds of work. A unit of a kind costs much the same whatever the configuration is.
 *
 * image, depth, pointmap, wavelet, labels, budget, disc_pixels, features: points. stereo, comparison: pixels of matched
 * and compared views. seeding, centres: points times SuperClusters. batches: points. neighbours: pairs of
 * SuperClusters. disc_gaussians, lifts: Gaussians. activations, macs: of a network, macs where its layers are packed.
 * refine_pixels, refine_gaussians: pixels that refinement draws, Gaussians that it lists for a view. corrections:
 * Gaussians times passes. remade_pixels: pixels drawn once more. raster_...: of one view at the largest target. */
#define WORK_KINDS(X)                                                                                                  \
    X(IMAGE, "image", IMAGE)                                                                                           \
    X(DEPTH, "depth", DEPTH)                                                                                           \
    X(STEREO, "stereo", DEPTH)                                                                                         \
    X(POINTMAP, "pointmap", POINTMAP)                                                                                  \
    X(COMPARISON, "comparison", POINTMAP)                                                                              \
    X(WAVELET, "wavelet", WAVELET)                                                                                     \
    X(SEEDING, "seeding", SUPERCLUSTERS)                                                                               \
    X(BATCHES, "batches", SUPERCLUSTERS)                                                                               \
    X(LABELS, "labels", SUPERCLUSTERS)                                                                                 \
    X(CENTRES, "centres", SUPERCLUSTERS)                                                                               \
    X(NEIGHBOURS, "neighbours", SUPERCLUSTERS)                                                                         \
    X(BUDGET, "budget", BUDGET)                                                                                        \
    X(DISC_PIXELS, "disc_pixels", HEAD)                                                                                \
    X(DISC_GAUSSIANS, "disc_gaussians", HEAD)                                                                          \
    X(FEATURES, "features", HEAD)                                                                                      \
    X(LIFTS, "lifts", HEAD)                                                                                            \
    X(ACTIVATIONS, "activations", HEAD)                                                                                \
    X(MACS, "macs", HEAD)                                                                                              \
    X(UNPACKED_MACS, "unpacked_macs", HEAD)                                                                            \
    X(REFINE_PIXELS, "refine_pixels", REFINE)                                                                          \
    X(REFINE_GAUSSIANS, "refine_gaussians", REFINE)                                                                    \
    X(CORRECTIONS, "corrections", REFINE)                                                                              \
    X(REMADE_PIXELS, "remade_pixels", REFINE)                                                                          \
    X(RASTER_PIXELS, "raster_pixels", RASTER)                                                                          \
    X(RASTER_GAUSSIANS, "raster_gaussians", RASTER)

#define WORK_KIND_(NAME, name, stage) WORK_##NAME,
typedef enum work_kind { WORK_KINDS(WORK_KIND_) WORK_KIND_COUNT } work_kind;

/* The units of each kind in a build from its views to its scene, and in one view drawn of it. */
typedef struct work_counts {
    uint64_t units[WORK_KIND_COUNT];
} work_counts;

/* The price of a unit of each kind, in 1/1000: of a nanosecond for a machine (bench --calibrate), of an operation in
 * work_operations. */
typedef struct work_prices {
    uint32_t milli[WORK_KIND_COUNT];
} work_prices;

/* Operations: instructions of plain C on x86-64, as gcc 12 -O2 makes them. No machine's time. */
extern const work_prices work_operations;

const char *work_name(work_kind kind);
t3r_stage work_stage(work_kind kind);

/* Counts the work of a build in an arena of `bytes`, with a depth or a match for every pixel and frames of the working
 * size. weights: the sound weights of a learned head, else NULL. The configuration is not of a stream. Returns the
 * status of t3r_init() with that configuration and arena. */
t3r_status work_count(const t3r_config *config, size_t bytes, const void *weights, work_counts *counts);

/* Returns what a stage's work takes: nanoseconds, or operations. */
double work_price(const work_counts *counts, const work_prices *prices, t3r_stage stage);
/* Returns what a build takes: all stages but the raster, which belongs to a view. */
double work_price_of_build(const work_counts *counts, const work_prices *prices);

#endif
