#include "reconstruction/options/settings.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/options/option_values.h"

static const char *wavelet_name(uint32_t value)
{
    return t3r_wavelet_name((t3r_wavelet)value);
}

static const char *allocation_name(uint32_t value)
{
    return t3r_allocation_name((t3r_allocation)value);
}

static const char *depth_name(uint32_t value)
{
    return t3r_depth_name((t3r_depth)value);
}

_Static_assert(sizeof(t3r_wavelet) == 4 && sizeof(t3r_allocation) == 4 && sizeof(t3r_depth) == 4,
               "a setting is read and written as 32 bits");

/* SETTING(option, argument, field of t3r_config, kind, low, high, names, help, column, word) */
#define SETTINGS                                                                                                       \
    SETTING("refine", "N", refinements, NUMBER, 0, T3R_MAX_REFINEMENTS, NULL,                                          \
            "passes of refinement on the context views, at most where they are fitted", true, "refine")                \
    SETTING("allocate", "MODE", allocation, NAME, T3R_ALLOCATE_CONFIGURED + 1, UINT32_MAX, allocation_name,            \
            "allocation of the budget over the points", true, NULL)                                                    \
    SETTING("depth", "SOURCE", depth, NAME, 0, UINT32_MAX, depth_name,                                                 \
            "source of depth; stereo matches the colours of two or more posed frames and ignores recorded depth",      \
            true, NULL)                                                                                                \
    SETTING("planes", "on|off", planes, SWITCH, 0, 1, NULL,                                                            \
            "continue what --depth stereo does not match along the planes of what it does", false, "planes")           \
    SETTING("wavelet", "NAME", wavelet, NAME, 0, UINT32_MAX, wavelet_name, "wavelet that measures texture", true,      \
            NULL)                                                                                                      \
    SETTING("levels", "N", wavelet_levels, NUMBER, 1, T3R_MAX_LEVELS, NULL, "wavelet levels", true, "levels")          \
    SETTING("clusters", "K", clusters, NUMBER, 0, T3R_MAX_CLUSTERS, NULL,                                              \
            "number of SuperClusters; 0 = as many as the allocation and the points ask for", true, "k")                \
    SETTING("gamma", "G", gamma_q8, Q8, 0, 2, NULL, "exponent of texture in the density", false, "gamma")              \
    SETTING("keep-percent", "N", keep_percent, NUMBER, 0, 100, NULL,                                                   \
            "percent of its points that a trimmed SuperCluster keeps, with --allocate paper", false, "keep-percent")   \
    SETTING("fill-radius", "N", fill_radius, NUMBER, 0, 8, NULL,                                                       \
            "fill holes of a depth sensor that measurements bracket within N pixels; 0 fills none", false,             \
            "fill-radius")                                                                                             \
    SETTING("bridge-radius", "N", bridge_radius, NUMBER, 0, 255, NULL,                                                 \
            "bridge wider holes, bracketed within N pixels, where no other view measured the surface; 0 bridges none", \
            false, "bridge-radius")                                                                                    \
    SETTING("flying", "on|off", flying, SWITCH, 0, 1, NULL,                                                            \
            "retain flying pixels last: points between surfaces, or in front of what another view measured", false,    \
            "flying")                                                                                                  \
    SETTING("redundancy", "on|off", redundancy, SWITCH, 0, 1, NULL,                                                    \
            "let small budgets pass over points whose surface another view shows as finely", false, "redundancy")      \
    SETTING("fit-passes", "on|off", fit_passes, SWITCH, 0, 1, NULL,                                                    \
            "take of --refine passes as many as the budget and the agreement of the views pay for", false,             \
            "fit-passes")                                                                                              \
    SETTING("fit-widths", "on|off", fit_widths, SWITCH, 0, 1, NULL,                                                    \
            "without refinement, fit the widths of splats of analytic to the points of all views", false,              \
            "fit-widths")                                                                                              \
    SETTING("structural", "on|off", structural, SWITCH, 0, 1, NULL,                                                    \
            "refine structure more than level: local contrast, and not what a whole view shows brighter", false,       \
            "structural")                                                                                              \
    SETTING("align", "on|off", align, SWITCH, 0, 1, NULL,                                                              \
            "correct the poses of the views until they show the same surfaces in the same colours", false, "align")    \
    SETTING("exposure", "on|off", exposure, SWITCH, 0, 1, NULL,                                                        \
            "bring the colours of all views to their mean exposure", false, "exposure")                                \
    SETTING("warm", "on|off", warm, SWITCH, 0, 1, NULL,                                                                \
            "let a build take over what still holds from the one before: with --slide and --stream of replay", false,  \
            "warm")                                                                                                    \
    SETTING("tile-splats", "N", tile_splats, NUMBER, 0, T3R_MAX_GAUSSIANS, NULL,                                       \
            "draw a tile of 16 x 16 pixels from its N nearest Gaussians alone; 0 = from all", false, "tile-splats")    \
    SETTING("seed", "N", seed, NUMBER, 0, UINT32_MAX, NULL, "seed of the K-means and of --allocate random", false,     \
            "seed")

const setting settings_table[] = {
#define SETTING(option, argument, field, kind, low, high, names, help, column, word)                                   \
    {option, argument, offsetof(t3r_config, field), SETTING_##kind, low, high, names, help, column, word},
    SETTINGS
#undef SETTING
};
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
    case SETTING_NUMBER:
        snprintf(text, bytes, "%" PRIu32, value);
        break;
    case SETTING_SWITCH:
        snprintf(text, bytes, "%s", value != 0 ? "on" : "off");
        break;
    case SETTING_Q8:
        snprintf(text, bytes, "%.4g", value / 256.0);
        break;
    case SETTING_NAME:
        snprintf(text, bytes, "%s", s->name(value));
        break;
    }
}

void settings_add_json(cJSON *object, const t3r_config *config)
{
    for (uint32_t i = 0; i < settings_count; i++) {
        const setting *s = &settings_table[i];
        uint32_t value = setting_value(s, config);
        switch (s->kind) {
        case SETTING_NUMBER:
            cJSON_AddNumberToObject(object, s->option, value);
            break;
        case SETTING_SWITCH:
            cJSON_AddBoolToObject(object, s->option, value != 0);
            break;
        case SETTING_Q8:
            cJSON_AddNumberToObject(object, s->option, value / 256.0);
            break;
        case SETTING_NAME:
            cJSON_AddStringToObject(object, s->option, s->name(value));
            break;
        }
    }
}

/* ---- the command line ------------------------------------------------------------------------------------------ */

#define FIRST_KEY 512 /* above those of the commands */

/* " (4)", ", 0..16 (4)", ": db2 (default), haar, cdf53": behind the help of a setting. */
static void append_values(const setting *s, char *text, size_t bytes)
{
    const t3r_config usual = t3r_default_config(T3R_MIN_SIDE, T3R_MIN_SIDE, 2, 1);
    char value[32];
    size_t length = strlen(text);
    setting_text(s, &usual, value, sizeof value);
    if (s->kind == SETTING_NAME) {
        length += (size_t)snprintf(text + length, bytes - length, ": %s (default)", value);
        for (uint32_t i = s->low; s->name(i) != NULL && length < bytes; i++) {
            if (i != setting_value(s, &usual)) {
                length += (size_t)snprintf(text + length, bytes - length, ", %s", s->name(i));
            }
        }
        return;
    }
    if (s->kind != SETTING_SWITCH && s->high != UINT32_MAX) {
        length += (size_t)snprintf(text + length, bytes - length, ", %" PRIu32 "..%" PRIu32, s->low, s->high);
    }
    if (s->kind == SETTING_Q8) { /* two digits: 0.7, which 1/256 holds as 0.6992 */
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
        return (char *)(uintptr_t)text; /* argp frees only what is another text */
    }
    snprintf(whole, bytes, "%s", text);
    append_values(&settings_table[key - FIRST_KEY], whole, bytes);
    return whole;
}

static uint32_t parse_q8(struct argp_state *state, const setting *s, const char *text)
{
    return (uint32_t)(option_decimal(state, s->option, text, s->low, s->high) * 256 + 0.5);
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
    case SETTING_SWITCH:
        return parse_switch(state, s, text);
    case SETTING_Q8:
        return parse_q8(state, s, text);
    case SETTING_NAME:
        return parse_name(state, s, text);
    case SETTING_NUMBER:
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

enum {
#define SETTING(option, argument, field, ...) AT_##field,
    SETTINGS
#undef SETTING
};

static const struct argp_option options[] = {
#define SETTING(option, argument, field, kind, low, high, names, help, ...)                                            \
    {option, FIRST_KEY + AT_##field, argument, 0, help, 20},
    SETTINGS
#undef SETTING
    {0},
};

const struct argp settings_argp = {.options = options, .parser = parse, .help_filter = complete_help};
