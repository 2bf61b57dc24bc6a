/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by all subcommands. The state here is per process: its name in messages and its progress line. */
#include "cli/cli.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "cli/text/style.h"
#include "cli/text/time_left.h"
#include "host/text.h"

#define MESSAGE_BYTES 2048
#define WARNING "warning:"

static const char *command_name;

static struct {
    char *text; /* NULL: errors go to stderr */
    size_t bytes;
} kept;

static struct {
    double started; /* 0: no progress line is open */
    double drawn;
    bool visible, silent;
    struct {
        const char *what;
        uint32_t before, done, total; /* 0: no outer work */
        double started;
    } outer;
} progress;

void cli_set_command(const char *name)
{
    command_name = name;
}

const char *cli_command(void)
{
    return command_name;
}

void cli_keep_errors(char *text, size_t bytes)
{
    kept.text = text;
    kept.bytes = bytes;
}

int cli_error(int code, const char *format, ...)
{
    char message[MESSAGE_BYTES];
    va_list arguments;
    cli_progress_end();
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    t3r_text_clean(message); /* messages contain names and contents of files */
    if (kept.text != NULL) {
        snprintf(kept.text, kept.bytes, "%s", message);
    } else {
        const size_t warning = strncmp(message, WARNING, strlen(WARNING)) == 0 ? strlen(WARNING) : 0;
        const char *end = style_end(stderr);
        fprintf(stderr, "%strim3r%s%s:%s ", code != CLI_OK ? style_begin(stderr, STYLE_ERROR) : "",
                command_name != NULL ? " " : "", command_name != NULL ? command_name : "", code != CLI_OK ? end : "");
        fprintf(stderr, "%s%.*s%s%s\n", warning > 0 ? style_begin(stderr, STYLE_WARNING) : "", (int)warning, message,
                warning > 0 ? end : "", message + warning);
    }
    return code;
}

/* Draws "12 of 400 rows, 3 min left   ". */
static void draw_outer(double now)
{
    uint32_t done = progress.outer.done, total = progress.outer.total;
    fprintf(stderr, "%" PRIu32 " of %" PRIu32 " %s", done, total, progress.outer.what);
    double left = cli_time_left(progress.outer.before, done, total, now - progress.outer.started);
    if (left >= 90) {
        fprintf(stderr, ", %.0f min left", left / 60);
    } else if (left >= 0) {
        fprintf(stderr, ", %.0f s left", left);
    }
    fputs("   ", stderr);
}

static bool draws(void)
{
    return !progress.silent && isatty(STDERR_FILENO);
}

void cli_progress(const char *what, uint32_t done, uint32_t total)
{
    double now = cli_now();
    if (progress.started <= 0) {
        progress.started = now;
    }
    if (now - progress.started < 0.5 || now - progress.drawn < 0.1 || !draws()) {
        return;
    }
    progress.drawn = now;
    progress.visible = true;
    uint32_t percent = total == 0 ? 100 : (uint32_t)((uint64_t)done * 100 / total);
    fputs("\r", stderr);
    if (progress.outer.total > 0) {
        draw_outer(now);
    }
    fprintf(stderr, "%-40.40s %3u %%", what, (unsigned)percent);
    fflush(stderr);
}

void cli_progress_within(const char *what, uint32_t before, uint32_t done, uint32_t total)
{
    if (progress.outer.total == 0) {
        progress.outer.started = cli_now();
    }
    progress.outer.what = what;
    progress.outer.before = before;
    progress.outer.done = done;
    progress.outer.total = done < total ? total : 0;
    if (progress.outer.total > 0 && draws()) {
        progress.visible = true;
        fputs("\r", stderr);
        draw_outer(cli_now());
        fputs("\033[K", stderr);
        fflush(stderr);
    }
}

void cli_progress_end(void)
{
    if (progress.visible) {
        fputs("\r\033[K", stderr);
        fflush(stderr);
    }
    progress.started = 0;
    progress.drawn = 0;
    progress.visible = false;
}

void cli_progress_silence(void)
{
    progress.silent = true;
}

/* Parses a decimal number at *text that fits 32 bits; *text moves past it. */
static int parse_u32(const char **text, uint32_t *value)
{
    const char *p = *text;
    uint64_t x = 0;
    if (*p < '0' || *p > '9') {
        return -1;
    }
    for (; *p >= '0' && *p <= '9'; p++) {
        x = x * 10 + (uint64_t)(*p - '0');
        if (x > UINT32_MAX) {
            return -1;
        }
    }
    *value = (uint32_t)x;
    *text = p;
    return 0;
}

/* Parses a count likewise: digits, or with k (thousands) or M (millions) after them, and then also with a point and as
 * many digits as give a whole number. */
static int parse_count(const char **text, uint32_t *value)
{
    const size_t digits = strspn(*text, "0123456789");
    const char *p = *text + digits + ((*text)[digits] == '.');
    const size_t places = p > *text + digits ? strspn(p, "0123456789") : 0;
    const char unit = p[places];
    const uint32_t zeros = unit == 'k' ? 3 : unit == 'M' ? 6 : 0;
    if (zeros == 0) {
        return parse_u32(text, value);
    }
    if (digits == 0 || digits > 9 || places > zeros || (p > *text + digits && places == 0)) {
        return -1;
    }
    uint64_t x = 0;
    for (const char *at = *text; *at != unit; at++) {
        x = *at == '.' ? x : x * 10 + (uint64_t)(*at - '0');
    }
    for (size_t i = places; i < zeros; i++) {
        x *= 10;
    }
    *value = (uint32_t)x;
    *text = p + places + 1;
    return x <= UINT32_MAX ? 0 : -1;
}

static int parse_list(const char *text, uint32_t *values, uint32_t most, uint32_t *count,
                      int (*parse)(const char **text, uint32_t *value))
{
    uint32_t n = 0;
    for (;;) {
        if (n == most || parse(&text, &values[n]) != 0) {
            return -1;
        }
        n++;
        if (*text == '\0') {
            *count = n;
            return 0;
        }
        if (*text++ != ',') {
            return -1;
        }
    }
}

int cli_parse_list_u32(const char *text, uint32_t *values, uint32_t most, uint32_t *count)
{
    return parse_list(text, values, most, count, parse_u32);
}

int cli_parse_list_counts(const char *text, uint32_t *values, uint32_t most, uint32_t *count)
{
    return parse_list(text, values, most, count, parse_count);
}

int cli_parse_list_percent(const char *text, double *values, uint32_t most, uint32_t *count)
{
    uint32_t n = 0;
    for (;;) {
        /* only digits and one point: strtod() would also take signs, exponents, hexadecimal and "nan" */
        size_t length = strspn(text, "0123456789.");
        char *end;
        if (n == most || length == 0) {
            return -1;
        }
        double value = strtod(text, &end);
        if (end != text + length || !(value > 0 && value <= 100)) {
            return -1;
        }
        values[n++] = value;
        text = end;
        if (*text == '%') {
            text++;
        }
        if (*text == '\0') {
            *count = n;
            return 0;
        }
        if (*text++ != ',') {
            return -1;
        }
    }
}

int cli_parse_size(const char *text, uint32_t *width, uint32_t *height)
{
    uint32_t w, h;
    if (parse_u32(&text, &w) != 0 || *text++ != 'x' || parse_u32(&text, &h) != 0 || *text != '\0' || w == 0 || h == 0) {
        return -1;
    }
    *width = w;
    *height = h;
    return 0;
}

double cli_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}
