/* What every subcommand shares: exit codes, messages, progress, one JSON object on stdout. */
#ifndef TRIM3R_TOOLS_CLI_H
#define TRIM3R_TOOLS_CLI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { CLI_OK = 0, CLI_BAD_INPUT = 1, CLI_BAD_USAGE = 2, CLI_BUDGET_TOO_SMALL = 3 };

/* "trim3r COMMAND: message" on stderr; returns `code`, so that `return cli_error(CLI_BAD_INPUT, ...)` reads well. */
int cli_error(int code, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* From here on cli_error() puts its messages, without the names before them, into text[] in the place of stderr, each
 * over the one before; NULL: stderr again. For callers to whom an error is a result. */
void cli_keep_errors(char *text, size_t bytes);
/* The command named in messages, and what it does; set by main. */
void cli_set_command(const char *name, const char *summary);
const char *cli_command(void);
const char *cli_command_summary(void);

/* A progress line on stderr, drawn only when stderr is a terminal and the work is long (over half a second). */
void cli_progress(const char *what, uint32_t done, uint32_t total);
void cli_progress_end(void);
/* What the lines to come are part of: "12 of 400 rows, 3 min left", by the time since the first of these calls; nothing
 * any more once all are done. before: how many of `done` were there already and took no time. */
void cli_progress_within(const char *what, uint32_t before, uint32_t done, uint32_t total);
/* None of it from here on: of a process that works for another. */
void cli_progress_silence(void);

/* "0,2" -> indices; "256x256" -> sizes; "10%" or "13107"; "100,60,40". 0, or -1 when malformed. */
int cli_parse_list_u32(const char *text, uint32_t *values, uint32_t most, uint32_t *count);
int cli_parse_list_percent(const char *text, double *values, uint32_t most, uint32_t *count);
int cli_parse_size(const char *text, uint32_t *width, uint32_t *height);

/* Seconds of a monotonic clock, for timings. */
double cli_now(void);

#endif
