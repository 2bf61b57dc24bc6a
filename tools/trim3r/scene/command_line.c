/* SPDX-License-Identifier: Apache-2.0 */
#include "trim3r/scene/command_line.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"

void line_begin(command_line *line, const char *name)
{
    *line = (command_line){.count = 0};
    line_add(line, name);
}

void line_add(command_line *line, const char *word)
{
    if (line->count == LINE_WORDS - 1) {
        abort(); /* lines have a fixed number of options */
    }
    line->words[line->count++] = (char *)(uintptr_t)word; /* argp's argv is not const, and is not changed */
}

void line_add_option(command_line *line, const char *option, const char *value)
{
    line_add(line, option);
    line_add(line, value);
}

void line_add_size(command_line *line, const char *option, uint32_t width, uint32_t height)
{
    char *text = line->texts[line->count];
    snprintf(text, LINE_TEXT_BYTES, "%" PRIu32 "x%" PRIu32, width, height);
    line_add_option(line, option, text);
}

/* Prints a word, in single quotes if a shell would read it otherwise. */
static void print_word(const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789%+,-./:=@_";
    if (*word != '\0' && word[strspn(word, plain)] == '\0') {
        fputs(word, stdout);
        return;
    }
    putchar('\'');
    for (; *word != '\0'; word++) {
        fputs(*word == '\'' ? "'\\''" : (const char[]){*word, '\0'}, stdout);
    }
    putchar('\'');
}

void line_print(const command_line *line)
{
    fputs(line->words[0], stdout);
    for (int i = 1; i < line->count; i++) {
        putchar(' ');
        print_word(line->words[i]);
    }
    putchar('\n');
}

void line_parse(command_line *line, const struct argp *argp, void *input)
{
    if (argp_parse(argp, line->count, line->words, 0, NULL, input) != 0) {
        exit(cli_error(CLI_BAD_INPUT, "out of memory for the options"));
    }
}
