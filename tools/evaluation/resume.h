/* SPDX-License-Identifier: Apache-2.0 */
/* The rows in an existing table, of an interrupted or an earlier evaluation. */
#ifndef TRIM3R_TOOLS_EVALUATION_RESUME_H
#define TRIM3R_TOOLS_EVALUATION_RESUME_H

#include <stdio.h>

#include "evaluation/evaluation.h"

typedef struct evaluation_resume {
    evaluation_row *rows;
    uint32_t count, room;
    uint32_t next; /* where the search for the next row starts, as rows arrive in about the same order */
    char **texts;  /* the texts that rows point into, one per row */
} evaluation_resume;

/* Reads the table; no file is an empty one. `with_pictures`: every row must name its render. The file is held to the
 * program's columns and bits epoch, and must be younger than the program, the `inputs` and the `scene` file (NULL:
 * none), or its rows may be of others. What follows its last newline is a row that was cut off, and is cut from the
 * file. An exit status of cli.h; evaluation_resume_close() in any case. */
int evaluation_resume_open(evaluation_resume *resume, const char *path, char *const *inputs, uint32_t input_count,
                           const char *scene, bool with_pictures);
/* Returns the row of the same case, contestant, budget and settings, or NULL. */
const evaluation_row *evaluation_resume_find(evaluation_resume *resume, const evaluation_row *named);
void evaluation_resume_close(evaluation_resume *resume);

#endif
