/* SPDX-License-Identifier: Apache-2.0 */
/* The unpruned scene of a context, its views and its scores, which all budgets and rivals share. */
#ifndef TRIM3R_TOOLS_RIVALS_SOURCE_H
#define TRIM3R_TOOLS_RIVALS_SOURCE_H

#include <stdbool.h>
#include <stdint.h>

#include "reconstruction/method.h"
#include "reconstruction/reconstruction.h"
#include "study/rivals/scores/kinds.h"
#include "study/rivals/splats/splat_view.h"

/* Shared by the scenes of one context; a method_source keeps it. All zero: nothing is open. */
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
    uint32_t *kept; /* indices in `whole` of the Gaussians of the scene made last, rising; NULL: none */
} rival_source;

/* Returns the source in `shared`, new if there is none; NULL if out of memory. */
rival_source *rival_source_open(method_source *shared, const t3r_recording *recording, const char *path,
                                const reconstruction_options *options);

/* Opens the context views as pictures: the frames and size that a build resolved, with its aligned poses. Returns an
 * exit status of cli.h. */
int rival_source_pictures(rival_source *source, const reconstruction *r);

/* Makes the unpruned scene and its scores. *account covers everything up to here, for the budget of `options`. Returns
 * an exit status of cli.h. */
int rival_source_rank(rival_source *source, method_kind kind, const reconstruction_options *options,
                      reconstruction_account *account);

/* Allocates `count` Gaussians in the frame of the scene in `r`, with harmonics of that degree. Returns false if out of
 * memory; call scene_file_free() in any case. */
bool rival_scene_open(const reconstruction *r, uint32_t count, uint32_t degree, scene_file *scene);

#endif
