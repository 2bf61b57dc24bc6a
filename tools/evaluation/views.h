/* SPDX-License-Identifier: Apache-2.0 */
/* Recorded views that renders are compared with, and the pixels that count.
 *
 * A case is one (scene, context, target). Its views are what all of its rows share: the recorded pictures through the
 * image stage, their cameras and their masks. No scene is built for a mask, so a mask favours no method and no head. */
#ifndef TRIM3R_TOOLS_EVALUATION_VIEWS_H
#define TRIM3R_TOOLS_EVALUATION_VIEWS_H

#include <stdbool.h>
#include <stdint.h>

#include "reconstruction/method.h"
#include "reconstruction/reconstruction.h"
#include "recording/recording.h"
#include "trim3r.h"

typedef struct evaluation_case {
    const t3r_recording *recording;
    const t3r_recording *recorded; /* the same with its recorded poses, if `recording` has estimated ones; else NULL */
    const char *path;              /* of the recording or image, for messages */
    const char *scene;             /* the scene's name in the tables */
    uint32_t context[T3R_MAX_VIEWS]; /* frame indices */
    uint32_t context_count;
    uint32_t target; /* a frame index */
    bool planar;     /* one image on a plane: the target is the context view itself, and all pixels count */
} evaluation_case;

/* A recorded frame at the working size. */
typedef struct evaluation_picture {
    t3r_camera camera; /* undistorted */
    t3r_camera placed; /* the same at its recorded pose: masks must not follow the estimates that they judge */
    uint8_t *rgb;      /* width x height x 3 */
    uint16_t *depth;   /* width x height steps, 0 = not measured; NULL = the frame has no depth of its own */
    double depth_unit; /* of a step, in world units */
    uint8_t *shown;    /* width x height, 255 = the recorded picture reaches it, 0 = beyond the lens: it never counts */
    uint8_t *mask;     /* width x height, 255 = counts, else 0 */
} evaluation_picture;

typedef struct evaluation_views {
    uint32_t width, height;
    bool sensed; /* every frame has a depth of its own, which makes the masks; else all shown pixels count */
    evaluation_picture target;
    evaluation_picture context[T3R_MAX_VIEWS];
    uint32_t context_count;
    method_source source; /* shared by the rows of a method */
} evaluation_views;

/* Reads the frames of a case at the working size of `settings`. The mask of a picture has the shown pixels whose
 * surface a context view saw (geometry/seen.h); in a context view itself, those with a depth. Without a depth of every
 * frame, and on a plane, it has all shown pixels. Call evaluation_views_free() after CLI_OK, and only then. */
int evaluation_views_make(evaluation_views *views, const evaluation_case *what, const reconstruction_options *settings);
void evaluation_views_free(evaluation_views *views);

#endif
