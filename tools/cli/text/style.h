/* SPDX-License-Identifier: Apache-2.0 */
/* Colours and weights on a terminal; files and pipes get none. The state is per process. */
#ifndef TRIM3R_TOOLS_STYLE_H
#define TRIM3R_TOOLS_STYLE_H

#include <argp.h>
#include <stdbool.h>
#include <stdio.h>

typedef enum style { STYLE_ERROR, STYLE_WARNING, STYLE_HEADING } style;

/* Sets --color: `auto` colours a stream that is a terminal, unless NO_COLOR is set or TERM is `dumb`. False: no such
 * word. */
bool style_choose(const char *when);
bool style_is_on(FILE *out);

/* Return the codes that enclose styled text; both are "" if the stream has no colours. */
const char *style_begin(FILE *out, style s);
const char *style_end(FILE *out);

/* Styles argp's usage errors and help; to be called when a parser gets ARGP_KEY_INIT. argp's output is collected in
 * memory, then written to its stream with colours when the process ends. */
void style_argp(struct argp_state *state);

#endif
