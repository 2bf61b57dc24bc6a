/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/option_values.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/text/index_ranges.h"
#include "trim3r.h"

error_t option_field(int key, char *argument, struct argp_state *state)
{
    void *field = (char *)state->input + (key & 0xffff);
    switch (key & ~0xffff) {
    case TO_SWITCH:
        *(bool *)field = true;
        return 0;
    case TO_TEXT:
        *(const char **)field = argument;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

uint32_t option_number(struct argp_state *state, const char *option, const char *text, uint32_t low, uint32_t high)
{
    uint32_t value = low, count;
    if (cli_parse_list_counts(text, &value, 1, &count) != 0 || value < low || value > high) {
        argp_error(state, "--%s takes a whole number %" PRIu32 "..%" PRIu32 ", not '%s'", option, low, high, text);
    }
    return value;
}

double option_decimal(struct argp_state *state, const char *option, const char *text, double low, double high)
{
    /* only digits, signs, a point and an exponent: strtod() would also take spaces, hexadecimal and "nan" */
    char *end;
    double value = strtod(text, &end);
    if (text[0] == '\0' || text[strspn(text, "0123456789.eE+-")] != '\0' || *end != '\0' ||
        !(value >= low && value <= high)) {
        argp_error(state, "--%s takes a number %g..%g, not '%s'", option, low, high, text);
    }
    return value;
}

uint32_t numbers_of_text(const char *text, double *numbers, uint32_t most)
{
    for (uint32_t count = 0; count < most; text++) {
        char *end;
        numbers[count] = strtod(text, &end);
        if (end == text || !(numbers[count] > -1e6 && numbers[count] < 1e6)) {
            return 0;
        }
        count++;
        text = end;
        if (*text != ',') {
            return *text == '\0' ? count : 0;
        }
    }
    return 0;
}

bool bytes_of_text(const char *text, uint64_t *bytes)
{
    char *end;
    const size_t digits = strspn(text, "0123456789");
    const uint64_t value = strtoull(text, &end, 10);
    const uint32_t shift = *end == 'k' || *end == 'K' ? 10 : *end == 'M' ? 20 : *end == 'G' ? 30 : 0;
    *bytes = value << shift;
    return digits > 0 && digits <= 9 + (shift == 0) * 8 && end[shift != 0] == '\0';
}

uint64_t option_bytes(struct argp_state *state, const char *option, const char *text)
{
    uint64_t bytes;
    if (!bytes_of_text(text, &bytes) || bytes == 0) {
        argp_error(state, "--%s takes a number of bytes, optionally followed by K, M or G, not '%s'", option, text);
    }
    return bytes;
}

uint64_t option_time(struct argp_state *state, const char *option, const char *text)
{
    const size_t digits = strspn(text, "0123456789.");
    const char *unit = text + digits;
    char *end;
    const double value = strtod(text, &end);
    const double each = *unit == '\0' || strcmp(unit, "ms") == 0 ? 1e6
                        : strcmp(unit, "us") == 0                ? 1e3
                        : strcmp(unit, "s") == 0                 ? 1e9
                                                                 : 0;
    const double most = 1e15; /* eleven days */
    if (digits == 0 || end != unit || !(value * each >= 1 && value * each <= most)) {
        argp_error(state, "--%s takes a time like 100ms, 0.1s or 900us, not '%s'", option, text);
    }
    return (uint64_t)(value * each);
}

void option_size(struct argp_state *state, const char *option, const char *text, uint32_t low, uint32_t *width,
                 uint32_t *height)
{
    if (cli_parse_size(text, width, height) != 0 || *width < low || *height < low || *width > T3R_MAX_SIDE ||
        *height > T3R_MAX_SIDE) {
        argp_error(state, "--%s takes WxH, each side %" PRIu32 "..%u, not '%s'", option, low, T3R_MAX_SIDE, text);
    }
}

void option_percents(struct argp_state *state, const char *option, const char *text, double *percents, uint32_t most,
                     uint32_t *count)
{
    if (cli_parse_list_percent(text, percents, most, count) != 0) {
        argp_error(state, "--%s takes %s above 0 and up to 100%s, not '%s'", option,
                   most == 1 ? "a percentage" : "percentages", most == 1 ? "" : " with commas between", text);
    }
}

void option_keep(struct argp_state *state, const char *text, double *percents, uint32_t most, uint32_t *count)
{
    option_percents(state, "keep", text, percents, most, count);
    for (uint32_t i = 0; i < *count; i++) {
        if (percents[i] < 1) {
            (void)cli_error(CLI_OK, "warning: --keep %g is %g percent of the points; a share of %g is --keep %g",
                            percents[i], percents[i], percents[i], percents[i] * 100);
            return;
        }
    }
}

void option_counts(struct argp_state *state, const char *option, const char *text, uint32_t high, uint32_t *counts,
                   uint32_t most, uint32_t *count)
{
    bool good = cli_parse_list_counts(text, counts, most, count) == 0;
    for (uint32_t i = 0; good && i < *count; i++) {
        good = counts[i] >= 1 && counts[i] <= high;
    }
    if (!good) {
        argp_error(state, "--%s takes at most %" PRIu32 " counts of 1..%" PRIu32 " with commas between, not '%s'",
                   option, most, high, text);
    }
}

void option_frames(struct argp_state *state, const char *option, const char *text, uint32_t *frames, uint32_t *count)
{
    const char *why = index_ranges_parse(text, frames, T3R_MAX_VIEWS, count);
    if (why != NULL) {
        argp_error(state, "--%s %s: '%s'; up to %u frames are named as in 0,2 or 0-3 or 0:11:2", option, why, text,
                   T3R_MAX_VIEWS);
    }
}

void option_arguments(struct argp_state *state, char ***arguments, uint32_t *count)
{
    *arguments = state->argv + state->next;
    *count = (uint32_t)(state->argc - state->next);
}

void option_argument(struct argp_state *state, const char *argument, const char **places[], uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (*places[i] == NULL) {
            *places[i] = argument;
            return;
        }
    }
    argp_error(state, "'%s' is too many", argument);
}
