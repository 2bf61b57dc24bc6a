/* SPDX-License-Identifier: Apache-2.0 */
/* The cases of an evaluation: triplets of recordings, or images, each on a plane. */
#ifndef TRIM3R_TOOLS_EVALUATION_CASES_H
#define TRIM3R_TOOLS_EVALUATION_CASES_H

#include "evaluation/evaluation.h"

/* Scenes are named after the last parts of their paths: as many as needed to distinguish them, at most this many. */
#define EVALUATION_NAME_PARTS_MOST 8u

typedef struct evaluation_cases {
    char **inputs; /* owned by the caller */
    uint32_t input_count;
    bool planar;
    uint32_t width, height; /* for planar images */
    poses_source poses;     /* for the context views of recordings */
    char (*names)[EVALUATION_NAME_BYTES];
    t3r_recording **recordings; /* one per input; none for an image */
    evaluation_case *list;      /* an image's recording is NULL until entered */
    uint32_t count;
} evaluation_cases;

/* Returns how many parts of their paths distinguish the inputs; 0 if two inputs cannot be distinguished, which
 * `pair` then names. */
uint32_t evaluation_name_parts(char *const *inputs, uint32_t count, uint32_t pair[2]);

/* All triplets of every recording, or the one of the settings' `context` (context_count above 0) and `target`. With
 * `context_views` above 2 the frames nearest to a triplet's target, by the median depth of the triplet's first frame
 * or, where it has none, what stereo makes of the triplet's context, fill its context up to that many
 * (context/nearest_views.h); a recording that has too few is refused. Opens all of them: a bad one is reported before
 * the work. An exit status of cli.h; evaluation_cases_close() in any case. */
int evaluation_cases_of_recordings(evaluation_cases *cases, char **inputs, uint32_t count,
                                   const reconstruction_options *settings, uint32_t target);
int evaluation_cases_of_images(evaluation_cases *cases, char **inputs, uint32_t count, uint32_t width, uint32_t height);
void evaluation_cases_close(evaluation_cases *cases);

/* A case with its recording open. */
typedef struct evaluation_entered {
    evaluation_case what;
    t3r_recording *own; /* an image's; or the case's, if its context views have poses of their own */
    uint8_t *bytes;
} evaluation_entered;

/* Estimates the poses of the context views if requested: the first view and the target keep theirs. Returns an exit
 * status of cli.h; call evaluation_case_leave() after CLI_OK. */
int evaluation_case_enter(evaluation_entered *entered, const evaluation_cases *cases, uint32_t index);
void evaluation_case_leave(evaluation_entered *entered);

#endif
