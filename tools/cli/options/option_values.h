/* SPDX-License-Identifier: Apache-2.0 */
/* Values of options for the commands' argp parsers. A bad one is a usage error that names the option and ends the
 * process: the function does not return. */
#ifndef TRIM3R_TOOLS_OPTION_VALUES_H
#define TRIM3R_TOOLS_OPTION_VALUES_H

#include <argp.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

/* Key of an option that fills one field of the parser's input, a struct `type`: a switch (bool) or a text. */
#define OPTION_TO(type, field)                                                                                         \
    ((int)offsetof(type, field) | _Generic(((type *)NULL)->field, bool : TO_SWITCH, const char * : TO_TEXT))
enum { TO_SWITCH = 0x100000, TO_TEXT = 0x200000 };
/* Fills the field of such a key. Returns ARGP_ERR_UNKNOWN for any other key. */
error_t option_field(int key, char *argument, struct argp_state *state);

/* Returns a whole number in [low, high], given as "13107", "10k" or "1.5M". */
uint32_t option_number(struct argp_state *state, const char *option, const char *text, uint32_t low, uint32_t high);
/* Returns a decimal number in [low, high], with or without an exponent. */
double option_decimal(struct argp_state *state, const char *option, const char *text, double low, double high);
/* Parses 1 to `most` numbers of less than a million, separated by commas. Returns their count, or 0 for other texts. */
uint32_t numbers_of_text(const char *text, double *numbers, uint32_t most);
/* Parses a number of bytes, optionally followed by K (2^10), M (2^20) or G (2^30). False: the text is none. */
bool bytes_of_text(const char *text, uint64_t *bytes);
/* The same as an option's value; must be above 0. */
uint64_t option_bytes(struct argp_state *state, const char *option, const char *text);
/* Returns a time above 0 in nanoseconds: a decimal number followed by ms, us or s, or nothing for ms. */
uint64_t option_time(struct argp_state *state, const char *option, const char *text);
/* Parses "WxH", each side in [low, T3R_MAX_SIDE]. */
void option_size(struct argp_state *state, const char *option, const char *text, uint32_t low, uint32_t *width,
                 uint32_t *height);
/* Parses 1 to `most` percentages above 0 and up to 100, with or without a percent sign, separated by commas. */
void option_percents(struct argp_state *state, const char *option, const char *text, double *percents, uint32_t most,
                     uint32_t *count);
/* Parses the percentages of --keep likewise; a value below 1, which may be meant as a share, gives a remark on
 * stderr. */
void option_keep(struct argp_state *state, const char *text, double *percents, uint32_t most, uint32_t *count);
/* Parses 1 to `most` such numbers in [1, high], separated by commas. */
void option_counts(struct argp_state *state, const char *option, const char *text, uint32_t high, uint32_t *counts,
                   uint32_t most, uint32_t *count);
/* Parses 1 to T3R_MAX_VIEWS frame indices, or ranges of them (index_ranges.h). */
void option_frames(struct argp_state *state, const char *option, const char *text, uint32_t *frames, uint32_t *count);
/* Returns all non-option arguments; for ARGP_KEY_ARGS. */
void option_arguments(struct argp_state *state, char ***arguments, uint32_t *count);
/* Stores a non-option argument in the next free one of `count` places. */
void option_argument(struct argp_state *state, const char *argument, const char **places[], uint32_t count);

#endif
