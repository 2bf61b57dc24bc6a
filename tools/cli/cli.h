/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by all subcommands: exit codes, messages, progress, one JSON object on stdout. */
#ifndef TRIM3R_TOOLS_CLI_H
#define TRIM3R_TOOLS_CLI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { CLI_OK = 0, CLI_BAD_INPUT = 1, CLI_BAD_USAGE = 2, CLI_BUDGET_TOO_SMALL = 3 };

/* Prints "trim3r COMMAND: message" on stderr; returns `code`, for use as `return cli_error(CLI_BAD_INPUT, ...)`. */
int cli_error(int code, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Makes cli_error() write its messages, without the names before them, into text[] instead of stderr, each replacing
 * the previous one; NULL: stderr again. For callers that treat an error as a result. */
void cli_keep_errors(char *text, size_t bytes);
/* Sets the command's name for messages; called by main. */
void cli_set_command(const char *name);
const char *cli_command(void);

/* Draws a progress line on stderr, only when stderr is a terminal and the work is long (over half a second). */
void cli_progress(const char *what, uint32_t done, uint32_t total);
void cli_progress_end(void);
/* Sets the outer work of the following progress lines: "12 of 400 rows, 3 min left", estimated from the time since the
 * first of these calls; nothing once all is done. before: number of `done` items that were there from the start and
 * took no time. */
void cli_progress_within(const char *what, uint32_t before, uint32_t done, uint32_t total);
/* Silences all progress from here on: for a process that works for another. */
void cli_progress_silence(void);

/* Parse "0,2" into indices; "13107,10k,1.5M" into counts, k being 1000 and M 1000000; "100,60,40%" into percentages;
 * "256x256" into sizes. Return 0, or -1 when malformed. */
int cli_parse_list_u32(const char *text, uint32_t *values, uint32_t most, uint32_t *count);
int cli_parse_list_counts(const char *text, uint32_t *values, uint32_t most, uint32_t *count);
int cli_parse_list_percent(const char *text, double *values, uint32_t most, uint32_t *count);
int cli_parse_size(const char *text, uint32_t *width, uint32_t *height);

/* Returns the seconds of a monotonic clock, for timings. */
double cli_now(void);

#endif
