/* The settings of the runtime that a user may change. A row of the table in settings.c feeds the parser, --help, the
 * words in tables and in names of pictures, and JSON. Defaults are those of t3r_default_config(). */
#ifndef TRIM3R_TOOLS_SETTINGS_H
#define TRIM3R_TOOLS_SETTINGS_H

#include <argp.h>
#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

typedef enum setting_kind {
    SETTING_NUMBER, /* a whole number, low..high */
    SETTING_SWITCH, /* on or off */
    SETTING_Q8,     /* a decimal number, low..high, which the configuration holds in 1/256 */
    SETTING_NAME    /* one of the names of the values low and up */
} setting_kind;

typedef struct setting {
    const char *option;   /* its name on the command line, in tables and in JSON */
    const char *argument; /* what --help calls its value */
    size_t offset;        /* in t3r_config, of a uint32_t or of an enumeration */
    setting_kind kind;
    uint32_t low, high;            /* UINT32_MAX: --help tells no range */
    const char *(*name)(uint32_t); /* of SETTING_NAME; NULL past the last value */
    const char *help;              /* to which --help adds the range and the default */
    bool column;                   /* `eval` has a column for it */
    const char *word;              /* before the value in names of pictures; NULL: names stand alone */
} setting;

extern const setting settings_table[];
extern const uint32_t settings_count;

/* The options of all settings. Each parent's parser hands a t3r_config * on in state->child_inputs[]. */
extern const struct argp settings_argp;

uint32_t setting_value(const setting *s, const t3r_config *config);
/* "0.5", "off", "haar": the value as the option takes it. */
void setting_text(const setting *s, const t3r_config *config, char *text, size_t bytes);
/* Every setting by its option's name. */
void settings_add_json(cJSON *object, const t3r_config *config);

#endif
