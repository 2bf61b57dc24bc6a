/* Colours and weights of what a terminal shows; files and pipes get none. The state is the process's own. */
#ifndef TRIM3R_TOOLS_STYLE_H
#define TRIM3R_TOOLS_STYLE_H

#include <argp.h>
#include <stdbool.h>
#include <stdio.h>

typedef enum style { STYLE_ERROR, STYLE_WARNING, STYLE_HEADING } style;

/* --color: `auto` colours a stream that is a terminal, unless NO_COLOR is set or TERM is `dumb`. False: no such word.
 */
bool style_choose(const char *when);
bool style_is_on(FILE *out);

/* The text between the two looks so; both are "" where the stream has no colours. */
const char *style_begin(FILE *out, style s);
const char *style_end(FILE *out);

/* Usage errors and help of argp's: to be called where a parser gets ARGP_KEY_INIT. What argp says goes into memory
 * then, and to its stream with colours as the process ends. */
void style_argp(struct argp_state *state);

#endif
