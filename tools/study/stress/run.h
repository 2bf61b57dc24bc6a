/* SPDX-License-Identifier: Apache-2.0 */
/* The contestants of a stress test, and one capture of a case that is ready to build from. */
#ifndef TRIM3R_TOOLS_STRESS_RUN_H
#define TRIM3R_TOOLS_STRESS_RUN_H

#include "evaluation/evaluation.h"
#include "study/rivals/methods.h"
#include "study/stress/capture.h"
#include "study/stress/perturbation.h"
#include "study/stress/row.h"

#define STRESS_KEEPS_MOST 16u

/* The contestants, and the number of captures of a still scene. */
typedef struct stress_contest {
    reconstruction_options settings;
    const method *methods[METHOD_COUNT];
    uint32_t method_count;
    double keep[STRESS_KEEPS_MOST];
    uint32_t keep_count;
    uint32_t captures; /* noisy captures; 0: measure no flicker and no stability */
    uint32_t seed;
} stress_contest;

/* Returns the number of rows of a cell, which are [budget][method]. */
static inline uint32_t stress_row_count(const stress_contest *contest)
{
    return contest->keep_count * contest->method_count;
}

typedef struct stress_case {
    const char *name, *context, *target; /* names for the tables */
    stress_capture base;
    evaluation_views views; /* target and masks, from the unperturbed frames */
    uint32_t budget[STRESS_KEEPS_MOST];
} stress_case;

/* Opens a case from `base`, which is already filled and which the caller frees. Returns an exit status of cli.h. */
int stress_case_open(stress_case *c, const stress_contest *contest);
void stress_case_close(stress_case *c);

/* One capture of a case, perturbed, recorded again, and ready to build from. */
typedef struct stress_run {
    stress_capture capture;
    uint8_t *bytes;
    t3r_recording *recording;
    evaluation_case what;
    evaluation_views views; /* target and masks of the case; its own source */
} stress_run;

/* Opens a capture. Capture 0 is scored; later ones also carry the noise of a still scene. `p` may be NULL. Returns an
 * exit status of cli.h, after a message; call stress_run_close() in any case. */
int stress_run_open(stress_run *run, const stress_case *c, const stress_contest *contest, const perturbation *p,
                    double strength, uint32_t capture);
void stress_run_close(stress_run *run);
/* Returns the settings of a build of the run at budget number `keep`; keep_count: all points. */
reconstruction_options stress_run_options(const stress_run *run, const stress_case *c, const stress_contest *contest,
                                          uint32_t keep);
/* Builds the run's scene by the options' method; close *built. Returns an exit status of cli.h. */
int stress_run_build(stress_run *run, const reconstruction_options *options, reconstruction *built,
                     reconstruction_account *account);

#endif
