/* SPDX-License-Identifier: Apache-2.0 */
/* The settings of the runtime that a user may change: the rows of trim3r_settings.h with an option. The parser,
 * --help, JSON, and the words in tables and in names of pictures are made from them. */
#ifndef TRIM3R_TOOLS_SETTINGS_H
#define TRIM3R_TOOLS_SETTINGS_H

#include <argp.h>
#include <cjson/cJSON.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

typedef enum setting_kind {
    SETTING_number,
    SETTING_q8,     /* a decimal number, stored in 1/256 */
    SETTING_toggle, /* on or off */
    SETTING_name    /* one of the names of the values low to high */
} setting_kind;

typedef struct setting {
    const char *option; /* the name on the command line, in tables and in JSON */
    size_t offset;      /* offset of 32 bits in t3r_config */
    setting_kind kind;
    uint32_t low, high;            /* UINT32_MAX: --help shows no range */
    const char *(*name)(uint32_t); /* for SETTING_name */
} setting;

extern const setting settings_table[];
extern const uint32_t settings_count;

/* Options of builds, and options of streams. Each parent's parser passes a t3r_config * in state->child_inputs[]. */
extern const struct argp settings_argp, stream_settings_argp;

/* Returns the option of the first setting of streams that is not the default, or NULL. */
const char *stream_setting_given(const t3r_config *config);

uint32_t setting_value(const setting *s, const t3r_config *config);
/* Writes the value as the option takes it: "0.5", "off", "haar". */
void setting_text(const setting *s, const t3r_config *config, char *text, size_t bytes);
/* Adds every setting by its option's name. */
void settings_add_json(cJSON *object, const t3r_config *config);

#endif
