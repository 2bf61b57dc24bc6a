/* SPDX-License-Identifier: Apache-2.0 */
/* The comparisons and outputs of `trim3r eval` from the command line. */
#ifndef TRIM3R_TOOLS_EVALUATION_OPTIONS_H
#define TRIM3R_TOOLS_EVALUATION_OPTIONS_H

#include <argp.h>

#include "evaluation/contestant.h"
#include "evaluation/report.h"

#define EVALUATION_BUDGETS_MOST 64u /* percents, and counts */

typedef struct evaluation_options {
    reconstruction_options settings;
    char **inputs; /* recordings, or the images of --planar */
    uint32_t input_count;
    bool planar, has_target, from_file;
    uint32_t width, height; /* --size */
    uint32_t target;
    double keep[EVALUATION_BUDGETS_MOST];
    uint32_t keep_count;
    uint32_t gaussians[EVALUATION_BUDGETS_MOST];
    uint32_t gaussians_count;
    char *heads[EVALUATION_HEADS_MOST]; /* --heads; parts of one heap string */
    uint32_t head_count;
    uint32_t processes;
    evaluation_outputs to;
} evaluation_options;

/* Sets defaults for evaluation_argp, which parses into evaluation_options *; call evaluation_options_free() after use.
 */
void evaluation_defaults(evaluation_options *options);
extern const struct argp evaluation_argp;
void evaluation_options_free(evaluation_options *options);

#endif
