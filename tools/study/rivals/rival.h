/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes by the rivals: the head's unpruned scene, pruned by a published score to an exact count, then left unchanged,
 * fine-tuned on the context views, or replaced by new Gaussians of trim3r's head at the same points. In floats on the
 * host: the promise of identical bits does not apply. */
#ifndef TRIM3R_TOOLS_RIVALS_RIVAL_H
#define TRIM3R_TOOLS_RIVALS_RIVAL_H

#include "reconstruction/reconstruction.h"
#include "study/rivals/choose.h"
#include "study/rivals/finetune.h"
#include "study/rivals/methods.h"
#include "study/rivals/splat_view.h"

/* Shared by the scenes of one context; rival_build() keeps it in its method_source. All zero: nothing is open. */
typedef struct rival_source {
    bool opened, built;
    const t3r_recording *recording;
    const char *path;
    reconstruction_options options; /* context and working size resolved once `opened` */
    uint8_t *rgb[T3R_MAX_VIEWS];    /* the context views, output of the image stage */
    t3r_camera camera[T3R_MAX_VIEWS];
    reconstruction whole; /* the unpruned scene, or the scene of the file `points_of`; valid once `built` */
    splat_model model;    /* the same as parameters */
    splat_view views[T3R_MAX_VIEWS];
    uint32_t view_count;
    double project_seconds;
    double *score[METHOD_KIND_COUNT]; /* NULL until computed */
    double score_seconds[METHOD_KIND_COUNT];
} rival_source;

/* The `build` of every method except trim3r, in an arena that only renders, or with +head in the arena of its build.
 * In *account the arena is the runtime's largest; the time is the total, including the unpruned scene, scoring and
 * fine-tuning. A scene from a file cannot be traced to points for a rival's +head: there the points are its
 * Gaussians, and the head is "". */
int rival_build(method_source *source, const t3r_recording *recording, const char *path,
                const reconstruction_options *options, reconstruction *made, reconstruction_account *account);

#endif
