/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes that the rivals make: the head's unpruned scene, pruned by a published score to an exact count; as it is,
 * fine-tuned on the context views, or as the points at which trim3r's head makes new Gaussians. Floats, on the host:
 * nothing here is covered by "same bits". */
#ifndef TRIM3R_TOOLS_RIVALS_RIVAL_H
#define TRIM3R_TOOLS_RIVALS_RIVAL_H

#include "reconstruction/reconstruction.h"
#include "study/rivals/choose.h"
#include "study/rivals/finetune.h"
#include "study/rivals/methods.h"
#include "study/rivals/splat_view.h"

/* What the scenes of one context share; rival_build() keeps it in its method_source. All zero: nothing is open. */
typedef struct rival_source {
    bool opened, built;
    const t3r_recording *recording;
    const char *path;
    reconstruction_options options; /* context and working size resolved once `opened` */
    uint8_t *rgb[T3R_MAX_VIEWS];    /* the context views as the image stage gives them */
    t3r_camera camera[T3R_MAX_VIEWS];
    reconstruction whole; /* the unpruned scene, or the scene of the file `points_of`; valid once `built` */
    splat_model model;    /* the same */
    splat_view views[T3R_MAX_VIEWS];
    uint32_t view_count;
    double project_seconds;
    double *score[METHOD_KIND_COUNT]; /* NULL until asked for */
    double score_seconds[METHOD_KIND_COUNT];
} rival_source;

/* The `build` of every method except trim3r, in an arena that only renders, or with +head in the arena of its build.
 * In *account the arena is the runtime's largest; the time is the total, including the unpruned scene, scoring and
 * fine-tuning. A scene from a file cannot be traced to points for a rival's +head: there the points are its
 * Gaussians, and the head is "". */
int rival_build(method_source *source, const t3r_recording *recording, const char *path,
                const reconstruction_options *options, reconstruction *made, reconstruction_account *account);

#endif
