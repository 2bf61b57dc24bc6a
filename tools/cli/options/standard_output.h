/* SPDX-License-Identifier: Apache-2.0 */
/* Standard output in the place of a file that a command writes: the word "-". */
#ifndef TRIM3R_TOOLS_STANDARD_OUTPUT_H
#define TRIM3R_TOOLS_STANDARD_OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

#define STANDARD_OUTPUT_WORD "-"

/* Keeps standard output for a file; from here on stdout leads to stderr. Returns 0, or -1 with errno. */
int standard_output_keep(void);
/* Whether the path stands for standard output, which is kept. */
bool standard_output_is(const char *path);
/* Opens the kept output; NULL with errno. */
FILE *standard_output_open(void);

#endif
