/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/text/style.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { AUTO, ALWAYS, NEVER };

static int chosen = AUTO;

bool style_choose(const char *when)
{
    static const char *const words[] = {[AUTO] = "auto", [ALWAYS] = "always", [NEVER] = "never"};
    for (int i = AUTO; i <= NEVER; i++) {
        if (strcmp(when, words[i]) == 0) {
            chosen = i;
            return true;
        }
    }
    return false;
}

bool style_is_on(FILE *out)
{
    const char *none = getenv("NO_COLOR"), *terminal = getenv("TERM");
    if (chosen != AUTO) {
        return chosen == ALWAYS;
    }
    return (none == NULL || *none == '\0') && terminal != NULL && strcmp(terminal, "dumb") != 0 && isatty(fileno(out));
}

const char *style_begin(FILE *out, style s)
{
    static const char *const codes[] = {
        [STYLE_ERROR] = "\033[1;31m", [STYLE_WARNING] = "\033[1;33m", [STYLE_HEADING] = "\033[1m"};
    return style_is_on(out) ? codes[s] : "";
}

const char *style_end(FILE *out)
{
    return style_is_on(out) ? "\033[0m" : "";
}

static struct {
    char *text; /* heap; NULL: argp writes to the stream itself */
    size_t bytes;
    FILE *memory;
} error_text, help_text;

/* Prints lines "trim3r plan: message" with style, other lines unchanged. */
static void print_errors(const char *text)
{
    const char *colon = strstr(text, ": ");
    const size_t name = strncmp(text, "trim3r", 6) == 0 && colon != NULL ? (size_t)(colon - text) + 1 : 0;
    if (name == 0) {
        fputs(text, stderr);
        return;
    }
    fprintf(stderr, "%s%.*s%s%s", style_begin(stderr, STYLE_ERROR), (int)name, text, style_end(stderr), text + name);
}

/* Prints help; a line that begins at the margin and ends with a colon is a heading. */
static void print_help(const char *text)
{
    for (const char *line = text; *line != '\0';) {
        const size_t bytes = strcspn(line, "\n");
        const bool heading = bytes > 1 && line[0] != ' ' && line[bytes - 1] == ':';
        printf("%s%.*s%s", heading ? style_begin(stdout, STYLE_HEADING) : "", (int)bytes, line,
               heading ? style_end(stdout) : "");
        line += bytes;
        if (*line == '\n') {
            putchar(*line++);
        }
    }
}

static void print_kept(void)
{
    if (error_text.memory != NULL) {
        fclose(error_text.memory);
        print_errors(error_text.text);
        free(error_text.text);
    }
    if (help_text.memory != NULL) {
        fclose(help_text.memory);
        print_help(help_text.text);
        free(help_text.text);
    }
}

void style_argp(struct argp_state *state)
{
    if (error_text.memory != NULL || help_text.memory != NULL) {
        return; /* from another parser of the same command */
    }
    error_text.memory = style_is_on(stderr) ? open_memstream(&error_text.text, &error_text.bytes) : NULL;
    help_text.memory = style_is_on(stdout) ? open_memstream(&help_text.text, &help_text.bytes) : NULL;
    state->err_stream = error_text.memory != NULL ? error_text.memory : state->err_stream;
    state->out_stream = help_text.memory != NULL ? help_text.memory : state->out_stream;
    if (error_text.memory != NULL || help_text.memory != NULL) {
        atexit(print_kept);
    }
}
