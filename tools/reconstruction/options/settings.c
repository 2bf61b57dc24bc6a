/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/options/settings.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/options/option_values.h"

#define SETTING_wavelet SETTING_name
#define SETTING_allocation SETTING_name
#define SETTING_depth SETTING_name

#define NAMES_number NULL
#define NAMES_q8 NULL
#define NAMES_toggle NULL
#define NAMES_wavelet t3r_wavelet_name
#define NAMES_allocation t3r_allocation_name
#define NAMES_depth t3r_depth_name

#define SETTING_OF_FIELD(...)
#define SETTING_OF_BUILD(name, kind, low, high, option)                                                                \
    {option, offsetof(t3r_config, name), SETTING_##kind, low, high, NAMES_##kind},
#define SETTING_OF_STREAM SETTING_OF_BUILD
#define SETTING(name, kind, low, high, usual, feature, from, group, option, help)                                      \
    SETTING_OF_##group(name, kind, low, high, option)

const setting settings_table[] = {T3R_SETTINGS(SETTING)};
enum { COUNT = sizeof settings_table / sizeof settings_table[0] };
const uint32_t settings_count = COUNT;

uint32_t setting_value(const setting *s, const t3r_config *config)
{
    uint32_t value;
    memcpy(&value, (const char *)config + s->offset, sizeof value);
    return value;
}

void setting_text(const setting *s, const t3r_config *config, char *text, size_t bytes)
{
    uint32_t value = setting_value(s, config);
    switch (s->kind) {
    case SETTING_number:
        snprintf(text, bytes, "%" PRIu32, value);
        break;
    case SETTING_toggle:
        snprintf(text, bytes, "%s", value != 0 ? "on" : "off");
        break;
    case SETTING_q8:
        snprintf(text, bytes, "%.4g", value / 256.0);
        break;
    case SETTING_name:
        snprintf(text, bytes, "%s", value <= s->high ? s->name(value) : "unknown");
        break;
    }
}

void settings_add_json(cJSON *object, const t3r_config *config)
{
    for (uint32_t i = 0; i < settings_count; i++) {
        const setting *s = &settings_table[i];
        uint32_t value = setting_value(s, config);
        switch (s->kind) {
        case SETTING_number:
            cJSON_AddNumberToObject(object, s->option, value);
            break;
        case SETTING_toggle:
            cJSON_AddBoolToObject(object, s->option, value != 0);
            break;
        case SETTING_q8:
            cJSON_AddNumberToObject(object, s->option, value / 256.0);
            break;
        case SETTING_name:
            cJSON_AddStringToObject(object, s->option, s->name(value));
            break;
        }
    }
}

#define NOT_ASKED(...)
#define GIVEN_OF_FIELD NOT_ASKED
#define GIVEN_OF_BUILD NOT_ASKED
#define GIVEN_OF_STREAM(name, option) config->name != usual.name ? option:
#define GIVEN(name, kind, low, high, usual, feature, from, group, option, help) GIVEN_OF_##group(name, option)

const char *stream_setting_given(const t3r_config *config)
{
    const t3r_config usual = t3r_default_config(T3R_MIN_SIDE, T3R_MIN_SIDE, 2, 1);
    return T3R_SETTINGS(GIVEN) NULL;
}

#define FIRST_KEY 512 /* above the commands' keys */

/* Appends the range and the default to the help of a setting: ", 0..16 (4)", " (on)". */
static void append_values(const setting *s, char *text, size_t bytes)
{
    const t3r_config usual = t3r_default_config(T3R_MIN_SIDE, T3R_MIN_SIDE, 2, 1);
    const uint32_t unit = s->kind == SETTING_q8 ? 256 : 1;
    char value[32];
    size_t length = strlen(text);
    setting_text(s, &usual, value, sizeof value);
    if ((s->kind == SETTING_number || s->kind == SETTING_q8) && s->high != UINT32_MAX) {
        length +=
            (size_t)snprintf(text + length, bytes - length, ", %" PRIu32 "..%" PRIu32, s->low / unit, s->high / unit);
    }
    if (s->kind == SETTING_q8) { /* two digits: 0.7 is stored in 1/256 as 0.6992 */
        snprintf(value, sizeof value, "%.2g", setting_value(s, &usual) / 256.0);
    }
    snprintf(text + length, bytes - length, " (%s)", value);
}

static char *complete_help(int key, const char *text, void *input)
{
    (void)input;
    char *whole;
    const size_t bytes = 512;
    if (key < FIRST_KEY || key >= FIRST_KEY + COUNT || (whole = malloc(bytes)) == NULL) {
        return (char *)(uintptr_t)text; /* argp frees only a different text */
    }
    snprintf(whole, bytes, "%s", text);
    append_values(&settings_table[key - FIRST_KEY], whole, bytes);
    return whole;
}

static uint32_t parse_q8(struct argp_state *state, const setting *s, const char *text)
{
    return (uint32_t)(option_decimal(state, s->option, text, s->low / 256.0, s->high / 256.0) * 256 + 0.5);
}

static uint32_t parse_switch(struct argp_state *state, const setting *s, const char *text)
{
    if (strcmp(text, "on") != 0 && strcmp(text, "off") != 0) {
        argp_error(state, "--%s takes on or off, not '%s'", s->option, text);
    }
    return strcmp(text, "on") == 0;
}

static uint32_t parse_name(struct argp_state *state, const setting *s, const char *text)
{
    char known[256] = "";
    size_t length = 0;
    for (uint32_t i = s->low; s->name(i) != NULL; i++) {
        if (strcmp(text, s->name(i)) == 0) {
            return i;
        }
        length += (size_t)snprintf(known + length, sizeof known - length, "%s%s", i == s->low ? "" : ", ", s->name(i));
    }
    argp_error(state, "--%s does not know '%s'; there are %s", s->option, text, known);
    return 0;
}

static uint32_t parse_value(struct argp_state *state, const setting *s, const char *text)
{
    switch (s->kind) {
    case SETTING_toggle:
        return parse_switch(state, s, text);
    case SETTING_q8:
        return parse_q8(state, s, text);
    case SETTING_name:
        return parse_name(state, s, text);
    case SETTING_number:
        break;
    }
    return option_number(state, s->option, text, s->low, s->high);
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    if (key < FIRST_KEY || key >= FIRST_KEY + COUNT) {
        return ARGP_ERR_UNKNOWN;
    }
    const setting *s = &settings_table[key - FIRST_KEY];
    uint32_t value = parse_value(state, s, arg);
    memcpy((char *)state->input + s->offset, &value, sizeof value);
    return 0;
}

#define KEY_OF_FIELD(name)
#define KEY_OF_BUILD(name) AT_##name,
#define KEY_OF_STREAM KEY_OF_BUILD
#define KEY(name, kind, low, high, usual, feature, from, group, ...) KEY_OF_##group(name)
enum { T3R_SETTINGS(KEY) };

/* The value's name in --help; for an enumeration its names, "db2|haar|cdf53". */
#define OR_NAME(NAME, name) "|" #name
#define ARGUMENT_number "N"
#define ARGUMENT_q8 "X"
#define ARGUMENT_toggle "on|off"
#define ARGUMENT_wavelet &(T3R_WAVELETS(OR_NAME))[1]
#define ARGUMENT_allocation &(T3R_ALLOCATIONS(OR_NAME))[1]
#define ARGUMENT_depth &(T3R_DEPTHS(OR_NAME))[1]

#define NO_OPTION(...)
#define AN_OPTION(group, name, kind, option, help) {option, FIRST_KEY + AT_##name, ARGUMENT_##kind, 0, help, group},
#define OPTION(name, kind, low, high, usual, feature, from, group, option, help)                                       \
    OPTION_OF_##group(name, kind, option, help)
#define OPTION_OF_FIELD NO_OPTION

#define OPTION_OF_BUILD(...) AN_OPTION(20, __VA_ARGS__)
#define OPTION_OF_STREAM NO_OPTION
static const struct argp_option options[] = {T3R_SETTINGS(OPTION){0}};

#undef OPTION_OF_BUILD
#undef OPTION_OF_STREAM
#define OPTION_OF_BUILD NO_OPTION
#define OPTION_OF_STREAM(...) AN_OPTION(5, __VA_ARGS__)
static const struct argp_option stream_options[] = {T3R_SETTINGS(OPTION){0}};

const struct argp settings_argp = {.options = options, .parser = parse, .help_filter = complete_help};
const struct argp stream_settings_argp = {.options = stream_options, .parser = parse, .help_filter = complete_help};
