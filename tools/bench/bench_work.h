/* SPDX-License-Identifier: Apache-2.0 */
/* The bench's work: two 256x256 views of the built-in room, the scenes made of them, and the inputs of single stages.
 */
#ifndef TRIM3R_TOOLS_BENCH_WORK_H
#define TRIM3R_TOOLS_BENCH_WORK_H

#include <stdbool.h>
#include <stdint.h>

#include "bench/bench_points.h"
#include "cli/options/processor_options.h"
#include "planning/bench_views.h"
#include "reconstruction/chosen_head.h"
#include "reconstruction/stage_times.h"
#include "trim3r_host.h"

#define BENCH_SIDE 256u
#define BENCH_VIEWS 2u
#define BENCH_POINTS (BENCH_SIDE * BENCH_SIDE * BENCH_VIEWS)
#define BENCH_TRIMMED_TO 13107u /* 10 % of the points */
#define BENCH_MORE_PATHS 8u     /* of stereo, compared with the pipeline's four */
#define BENCH_WAVELET_WIDTH 1280u
#define BENCH_WAVELET_HEIGHT 720u

/* The scenes that stages work on; each is built before the first stage that needs it. */
typedef enum bench_scene {
    BENCH_FULL,
    BENCH_TRIMMED,
    BENCH_UNREFINED,
    BENCH_LEARNED,
    BENCH_REFINED,
    BENCH_MATCHED,
    BENCH_HEADED,
    BENCH_NETWORKED,
    BENCH_SCENES,
    BENCH_NO_SCENE = BENCH_SCENES
} bench_scene;

typedef struct bench_settings {
    const char *points; /* a file of points to cluster instead of the room's; NULL = none */
    const char *head;   /* for BENCH_HEADED and BENCH_NETWORKED */
    t3r_depth depth;    /* for the scenes */
    processor_options processor;
} bench_settings;

typedef struct bench_work {
    t3r_depth source;
    bench_views views;
    t3r_camera viewpoint;
    struct {
        t3r_runtime *runtime;
        void *arena;
    } scene[BENCH_SCENES];
    t3r_gaussian *start; /* start of each measured refinement pass: its scene as built */
    void *stereo_work;   /* for a pair matched with eight paths */
    int8_t *features;    /* input of the network alone */
    chosen_head small, measured;
    t3r_threads *threads;
    uint32_t cpu; /* features that kernels may use */
    t3r_kernels kernels;
    uint8_t *view; /* target of renders */
    uint8_t *wavelet_rgb;
    uint8_t *wavelet_planes;
    int16_t *wavelet_plane, *wavelet_work;
    uint16_t *texture;
    uint8_t *copy_from, *copy_to;
    double multiply_adds; /* count of the last bench_multiply_adds() */
    bench_points points;
} bench_work;

/* Returns an exit status of cli.h after a message; bench_work_close() is due in any case. */
int bench_work_open(bench_work *work, const bench_settings *settings);
/* Builds the scene, unless it has been built. */
t3r_status bench_work_open_scene(bench_work *work, bench_scene scene);
/* Builds the scene from the frames again. */
t3r_status bench_work_build(bench_work *work, bench_scene scene);
/* The same with the time of each stage; it collects hashes, so the whole takes longer. */
t3r_status bench_work_profile(bench_work *work, bench_scene scene, stage_times *times);
/* Draws the view between the context views. */
t3r_status bench_work_draw(bench_work *work, bench_scene scene);
void bench_work_close(bench_work *work);

#endif
