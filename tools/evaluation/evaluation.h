/* SPDX-License-Identifier: Apache-2.0 */
/* Scores of views that a reconstruction was not given.
 *
 * evaluation_measure() builds one scene of a case (views.h) and scores it: one row. Functions that can fail report on
 * stderr and return an exit status of cli.h. */
#ifndef TRIM3R_TOOLS_EVALUATION_H
#define TRIM3R_TOOLS_EVALUATION_H

#include <stdbool.h>
#include <stdint.h>

#include "evaluation/settings.h"
#include "evaluation/views.h"
#include "reconstruction/reconstruction.h"
#include "trim3r.h"

#define EVALUATION_NAME_BYTES 256 /* of a scene's name */
#define EVALUATION_SCENE "scene"  /* instead of a method: a scene file, unchanged */

/* The number of Gaussians of a row. */
typedef struct evaluation_budget {
    double keep;        /* percent of the valid points, if no count is given */
    uint32_t gaussians; /* a count, or all valid points if they are fewer; 0 = not given */
} evaluation_budget;

/* The numbers of a row; NaN = does not apply. */
typedef enum evaluation_value {
    EVALUATION_KEEP,      /* percent of the valid points; NaN for a budget given as a count */
    EVALUATION_REQUESTED, /* the budget's count */
    EVALUATION_GAUSSIANS, /* count used */
    EVALUATION_PSNR_ALL,  /* all pixels that the recorded picture reaches, over black, dB; the next two likewise */
    EVALUATION_SSIM_ALL,
    EVALUATION_PERCEPTUAL_ALL, /* FLIP */
    EVALUATION_PSNR,           /* on the mask, over black, dB */
    EVALUATION_SSIM,
    EVALUATION_SHARP,
    EVALUATION_HOLES,        /* share of mask pixels with transmittance above 1/2 */
    EVALUATION_PSNR_SEEN,    /* the same as EVALUATION_PSNR; NaN without a depth of every frame */
    EVALUATION_CONTEXT_PSNR, /* mean over the context views on their masks, dB */
    EVALUATION_PERCEPTUAL,   /* FLIP on the mask */
    EVALUATION_BUILD_MS,  /* frames to scene: the image stage and all later steps, including scoring and fine-tuning */
    EVALUATION_RENDER_MS, /* the target view */
    EVALUATION_ARENA_BYTES,
    EVALUATION_SCENE_BYTES, /* size of the Gaussians in the arena */
    EVALUATION_PLANAR_PSNR, /* all pixels of a planar case, dB */
    EVALUATION_BITS_EPOCH,
    EVALUATION_LOSS, /* measured by --auto, dB */
    EVALUATION_VALUE_COUNT
} evaluation_value;

typedef struct evaluation_row {
    char scene[EVALUATION_NAME_BYTES], context[192], target[16], head[16], bits[8], refine[16];
    char levels[8], clusters[16]; /* "" = does not apply, as below */
    const char *method, *allocate, *depth, *wavelet;
    const char *ablation;                     /* name of the removed part; "" if none */
    char settings[EVALUATION_SETTINGS_BYTES]; /* all others: evaluation_settings_rest() */
    char picture[512];                        /* path of its render in the folder of --images; "" = none */
    double value[EVALUATION_VALUE_COUNT];
} evaluation_row;

/* Sets the row's scene, context and target. */
void evaluation_name_case(evaluation_row *row, const evaluation_case *what);

/* Fills in the values known in advance: every text except the ablation and the picture, and the budget; other values
 * are NaN. Returns an exit status of cli.h, because it reads the head. */
int evaluation_name_row(evaluation_row *row, const evaluation_case *what, evaluation_budget budget,
                        const reconstruction_options *settings);

/* Builds `what` by the settings' method with that number of Gaussians, renders and scores it. The views keep what the
 * rows of a method share, so `settings` must be the same for all of these rows. With from_file the scene is written as
 * .ply, read back and rendered from that file. If the settings name a scene file, that scene is rendered and nothing
 * is built. `render` (width x height x 3) gets the target view. */
int evaluation_measure(evaluation_row *row, uint8_t *render, evaluation_views *views, const evaluation_case *what,
                       evaluation_budget budget, bool from_file, const reconstruction_options *settings);

/* The steps of evaluation_measure() after the build, for callers that build from frames other than the views'
 * (stress). evaluation_draw() renders the scene as `camera` sees it; rgb (width x height x 3) or alpha (width
 * x height, 32767 = opaque) may be NULL. evaluation_score() renders the target into `render` and fills the scores
 * and render_ms of *row; context_psnr is NaN if the views hold no context. `account`: of the build, for the pose and
 * the exposure of the views (corrected_views.h); NULL = they are drawn from their own cameras. */
int evaluation_draw(reconstruction *r, const t3r_camera *camera, const evaluation_views *views, uint8_t *rgb,
                    uint16_t *alpha);
int evaluation_score(evaluation_row *row, uint8_t *render, const evaluation_views *views, const evaluation_case *what,
                     reconstruction *r, const reconstruction_account *account);

#endif
