/* Values of options as the commands' argp parsers read them. A bad one is a usage error that names the option, which
 * ends the process: nothing is returned then. */
#ifndef TRIM3R_TOOLS_OPTION_VALUES_H
#define TRIM3R_TOOLS_OPTION_VALUES_H

#include <argp.h>
#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

/* A whole number in [low, high]. */
uint32_t option_number(struct argp_state *state, const char *option, const char *text, uint32_t low, uint32_t high);
/* A decimal number in [low, high], with an exponent or not. */
double option_decimal(struct argp_state *state, const char *option, const char *text, double low, double high);
/* A number of bytes, with K (2^10), M (2^20) or G (2^30) behind it or not. False: the text is none. */
bool bytes_of_text(const char *text, uint64_t *bytes);
/* The same, above 0. */
uint64_t option_bytes(struct argp_state *state, const char *option, const char *text);
/* A time above 0 in nanoseconds: a decimal number with ms, us or s behind it, or ms without. */
uint64_t option_time(struct argp_state *state, const char *option, const char *text);
/* "WxH", each side in [low, T3R_MAX_SIDE]. */
void option_size(struct argp_state *state, const char *option, const char *text, uint32_t low, uint32_t *width,
                 uint32_t *height);
/* 1 to `most` percentages above 0 and up to 100, with or without their sign, commas between. */
void option_percents(struct argp_state *state, const char *option, const char *text, double *percents, uint32_t most,
                     uint32_t *count);
/* The percentages of --keep: likewise, with a word on stderr where one below 1 may be meant as a share. */
void option_keep(struct argp_state *state, const char *text, double *percents, uint32_t most, uint32_t *count);
/* 1 to `most` counts in [1, high] with commas between. */
void option_counts(struct argp_state *state, const char *option, const char *text, uint32_t high, uint32_t *counts,
                   uint32_t most, uint32_t *count);
/* 1 to T3R_MAX_VIEWS frame indices with commas between. */
void option_frames(struct argp_state *state, const char *option, const char *text, uint32_t *frames, uint32_t *count);
/* All arguments that are no options; of ARGP_KEY_ARGS. */
void option_arguments(struct argp_state *state, char ***arguments, uint32_t *count);
/* The next free one of `count` places for arguments that are no options. */
void option_argument(struct argp_state *state, const char *argument, const char **places[], uint32_t count);

#endif
