/* SPDX-License-Identifier: Apache-2.0 */
/* A command of trim3r with its arguments, to be shown or run. */
#ifndef TRIM3R_TOOLS_COMMAND_LINE_H
#define TRIM3R_TOOLS_COMMAND_LINE_H

#include <argp.h>
#include <stdint.h>

enum { LINE_WORDS = 24, LINE_TEXT_BYTES = 64 };

typedef struct command_line {
    char *words[LINE_WORDS]; /* the first is "trim3r COMMAND"; owned by the caller, or in texts[] */
    int count;
    char texts[LINE_WORDS][LINE_TEXT_BYTES];
} command_line;

/* Begins a line; `name` is "trim3r COMMAND". */
void line_begin(command_line *line, const char *name);
/* Adds a word, which is kept by reference. */
void line_add(command_line *line, const char *word);
/* Adds an option and its value. */
void line_add_option(command_line *line, const char *option, const char *value);
/* Adds "WxH" likewise. */
void line_add_size(command_line *line, const char *option, uint32_t width, uint32_t height);

/* Prints the line on stdout so that a shell reads the same words. */
void line_print(const command_line *line);
/* Parses the line with a command's own parser; ends the process on an error, as that command does. */
void line_parse(command_line *line, const struct argp *argp, void *input);

#endif
