/* SPDX-License-Identifier: Apache-2.0 */
/* The settings of the runtime that a user may change: the rows of trim3r_settings.h with an option. They feed the
 * parser,
 * --help, the words in tables and in names of pictures, and JSON. */
#ifndef TRIM3R_TOOLS_SETTINGS_H
#define TRIM3R_TOOLS_SETTINGS_H

#include <argp.h>
#include <cjson/cJSON.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

typedef enum setting_kind {
    SETTING_number,
    SETTING_q8,     /* a decimal number, which the configuration holds in 1/256 */
    SETTING_toggle, /* on or off */
    SETTING_name    /* one of the names of the values low and up */
} setting_kind;

typedef struct setting {
    const char *option; /* its name on the command line, in tables and in JSON */
    size_t offset;      /* in t3r_config, of 32 bits */
    setting_kind kind;
    uint32_t low, high;            /* UINT32_MAX: --help shows no range */
    const char *(*name)(uint32_t); /* of SETTING_name */
} setting;

extern const setting settings_table[];
extern const uint32_t settings_count;

/* The options of builds, and those of streams. Each parent's parser hands a t3r_config * on in state->child_inputs[].
 */
extern const struct argp settings_argp, stream_settings_argp;

uint32_t setting_value(const setting *s, const t3r_config *config);
/* "0.5", "off", "haar": the value as the option takes it. */
void setting_text(const setting *s, const t3r_config *config, char *text, size_t bytes);
/* Every setting by its option's name. */
void settings_add_json(cJSON *object, const t3r_config *config);

#endif
