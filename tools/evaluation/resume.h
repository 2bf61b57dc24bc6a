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

/* Reads the table; a missing file counts as empty. `with_pictures`: every row must name its render. The file must have
 * the program's columns, and be younger than the program, the `inputs` and the `scene` file (NULL: none), since its
 * rows could otherwise be outdated. A row after the last newline was cut off, and is removed from the file. Returns an
 * exit status of cli.h; call evaluation_resume_close() in any case. */
int evaluation_resume_open(evaluation_resume *resume, const char *path, char *const *inputs, uint32_t input_count,
                           const char *scene, bool with_pictures);
/* Returns the row of the same case, contestant, budget and settings, or NULL. */
const evaluation_row *evaluation_resume_find(evaluation_resume *resume, const evaluation_row *named);
void evaluation_resume_close(evaluation_resume *resume);

#endif
