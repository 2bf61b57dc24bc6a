/* SPDX-License-Identifier: Apache-2.0 */
/* The head of the arena: the runtime's whole state except the planes. It has offsets instead of pointers, so that a
 * copied arena works. The hooks, the bound weights and the table of kernels are exceptions: t3r_attach() clears the
 * first two and fills the third again. */
#ifndef T3R_STATE_H
#define T3R_STATE_H

#include <stdbool.h>
#include <stdint.h>

#include "ablation.h"
#include "core/assertion.h"
#include "core/features.h"
#include "core/fixed.h"
#include "core/placement.h"
#include "core/workers.h"
#include "kernels/kernels.h"
#include "reuse.h"
#include "trim3r.h"
#include "views.h"

#define T3R_MAGIC 0x72336d74u /* "tm3r" */

/* Refuses misuse of the API (null pointers, calls out of order, calls after an error) with a status in every build. A
 * debug build may stop here, too. */
#define T3R_REFUSE_UNLESS(condition, status)                                                                           \
    do {                                                                                                               \
        T3R_ASSERT(condition);                                                                                         \
        if (!(condition)) {                                                                                            \
            return (status);                                                                                           \
        }                                                                                                              \
    } while (0)

/* Parameters of a scene: the configuration's values or the request's. */
typedef struct t3r_build {
    uint32_t gaussians; /* 1..max_gaussians */
    t3r_allocation allocate;
    t3r_head head;
    uint32_t refine; /* 0..the configuration's */
} t3r_build;

/* Returns the configuration's parameters. A stream allocates by pixel instead of by SuperCluster, so that keys mean
 * the same in every keyframe. */
static inline t3r_build t3r_build_of(const t3r_config *config)
{
    const bool clustered = config->allocate == T3R_ALLOCATE_DENSITY || config->allocate == T3R_ALLOCATE_PAPER;
    const t3r_allocation allocation = t3r_is_stream(config) && clustered ? T3R_ALLOCATE_PIXEL : config->allocate;
    return (t3r_build){config->gaussians, allocation, config->head, config->refine};
}

/* A context view that arrives in strips: the rows received, and a digest of the frame they belong to. */
typedef struct t3r_strips {
    uint64_t digest;
    uint32_t rows, depth_rows;
} t3r_strips;

/* A stream's gate: its memory of earlier frames. Any values are safe. */
typedef struct t3r_gate {
    t3r_placement contradicts_from; /* camera of the first frame of those that contradicted the map last */
    int32_t refused_at_q20[3];      /* camera of the frame refused last, scene units */
    uint16_t detail_q8;             /* mean of the keyframes' figures; 0 = none yet */
    uint8_t refused;                /* frames in a row, for reasons that may last */
    uint8_t refusal;                /* the reason of the last frame */
} t3r_gate;

struct t3r_runtime {
    uint32_t magic;
    uint32_t bits_epoch;
    uint64_t arena_bytes;
    uint64_t layout_hash;
    t3r_config config; /* from t3r_init(), with values for settings left open (t3r_settled) */
    t3r_ablation ablation;
    t3r_build build; /* of the scene, or of the last attempt at one */
    uint64_t offset[T3R_BUFFER_COUNT];
    uint64_t list_capacity;                  /* entries of the tile lists */
    uint64_t refine_bytes;                   /* of the refinement work */
    uint32_t views;                          /* context views added */
    t3r_camera camera[T3R_MAX_VIEWS];        /* at the working size, undistorted; with the poses in use */
    t3r_placement given[T3R_MAX_VIEWS];      /* poses as views were added; unused by a stream */
    int32_t deviation_q30[T3R_MAX_VIEWS][6]; /* of the pose in use from the given one: radians, scene units */
    uint64_t depth_unit_q40[T3R_MAX_VIEWS];
    uint32_t analysed; /* labels, clusters and blurred textures belong to the current views */
    uint32_t has_scene;
    t3r_scene_frame frame;
    int32_t median_depth_q20; /* scene units, [1, 2) */
    uint32_t valid_points;
    uint8_t stereo_pair[T3R_MAX_VIEWS];    /* t3r_pair of each view, with stereo */
    uint8_t stereo_partner[T3R_MAX_VIEWS]; /* partner view */
    uint16_t gain_q14[T3R_MAX_VIEWS][3];   /* brings r, g, b of a view to the mean exposure */
    uint32_t gaussians;                    /* in the scene */
    uint32_t passes;                       /* refinement passes of the last build */
    uint32_t render_passes;
    uint32_t head_crc;   /* of the weights bound last */
    uint32_t keyframes;  /* taken by a stream; the last `views` of them are retained */
    uint32_t next_slot;  /* the view that a stream's next keyframe replaces; with `warm`, that the next view replaces
                            when all slots are used */
    uint32_t remembered; /* keyframes that a stream keeps without planes, at most config.remember */
    t3r_gate gate;       /* 0 without a stream */
    t3r_reuse reuse;     /* empty without `warm` */
    uint32_t follows;    /* 1 = the last analysis reused something */
    t3r_strips strips;   /* 0 unless a view arrives in strips */
    const void *weights;
    const t3r_runtime *depth_of; /* has the views, too: the next analysis takes its depth by stereo. NULL: none */
    t3r_hooks hooks;
    t3r_kernels kernels; /* chosen by t3r_set_cpu(); plain C until then */
};

_Static_assert(sizeof(struct t3r_runtime) <= T3R_HEADER_BYTES, "the state outgrew its buffer");

static inline void *t3r_buffer_at(const t3r_runtime *rt, enum t3r_buffer buffer)
{
    return (uint8_t *)(uintptr_t)rt + rt->offset[buffer];
}

/* Calls the progress hook. Returns true to go on. */
static inline bool t3r_progress(const t3r_runtime *rt, t3r_stage stage, uint32_t done, uint32_t total)
{
    return rt->hooks.progress == NULL || rt->hooks.progress(rt->hooks.user, stage, done, total) == 0;
}

/* Sets view v's camera to the given pose. */
static inline void t3r_pose_as_given(t3r_runtime *rt, uint32_t v)
{
    t3r_place_camera(&rt->camera[v], &rt->given[v]);
    memset(rt->deviation_q30[v], 0, sizeof rt->deviation_q30[v]);
}

/* Returns how many Gaussians a build makes: its budget, or the number of valid points if that is less. Filled holes and
 * the rim don't raise it. */
static inline uint32_t t3r_gaussians_of(const t3r_runtime *rt)
{
    return T3R_MIN(rt->build.gaussians, rt->valid_points);
}

static inline t3r_workers t3r_workers_of(const t3r_runtime *rt)
{
    return (t3r_workers){&rt->hooks, rt->config.workers};
}

#endif
