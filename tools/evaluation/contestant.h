/* SPDX-License-Identifier: Apache-2.0 */
/* A contestant has its own rows in an evaluation: trim3r once per head, or a program's addition. */
#ifndef TRIM3R_TOOLS_EVALUATION_CONTESTANT_H
#define TRIM3R_TOOLS_EVALUATION_CONTESTANT_H

#include "reconstruction/method.h"

#define EVALUATION_HEADS_MOST 32u
#define EVALUATION_CONTESTANTS_MOST 64u
#define EVALUATION_LABEL_BYTES 40

typedef struct evaluation_contestant {
    reconstruction_options settings;
    const char *ablation;               /* the row's; "" = none */
    char label[EVALUATION_LABEL_BYTES]; /* above its pictures and in their names */
} evaluation_contestant;

typedef struct evaluation_contestants {
    evaluation_contestant list[EVALUATION_CONTESTANTS_MOST];
    uint32_t count;
} evaluation_contestants;

/* Adds a contestant with these settings: there is room for heads, methods and ablations. Its name is its method, or
 * its ablation if it has one. */
void evaluation_contestants_add(evaluation_contestants *chosen, const reconstruction_options *settings,
                                const char *ablation);

/* Adds trim3r with these settings: once for each of `heads`, or, without heads, with the settings' head. Opens every
 * head once, so that a bad one is reported before the work. Returns an exit status of cli.h after a message. */
int evaluation_contestants_add_heads(evaluation_contestants *chosen, char *const *heads, uint32_t head_count,
                                     const reconstruction_options *settings);

/* Adds only the settings' scene file. */
void evaluation_contestants_scene(evaluation_contestants *chosen, const reconstruction_options *settings);

#endif
