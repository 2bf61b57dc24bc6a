#include "reconstruction/options/option_names.h"

#include <string.h>

#include "reconstruction/options/chosen_head.h"

const char *option_head(struct argp_state *state, const char *option, const char *text)
{
    if (!chosen_head_is_one(text)) {
        char names[CHOSEN_HEAD_NAMES_BYTES];
        argp_error(state, "--%s does not know '%s'; there are %s", option, text, chosen_head_names(names));
    }
    return text;
}

t3r_depth option_depth(struct argp_state *state, const char *option, const char *text)
{
    int depth = 0;
    while (depth < T3R_DEPTH_COUNT && strcmp(text, t3r_depth_name((t3r_depth)depth)) != 0) {
        depth++;
    }
    if (depth == T3R_DEPTH_COUNT) {
        argp_error(state, "--%s does not know '%s'; there are sensor, stereo", option, text);
    }
    return (t3r_depth)depth;
}

void option_effort(struct argp_state *state, const char *option, const char *text, t3r_config *config,
                   const char **head)
{
    t3r_effort effort = 0;
    while (effort < T3R_EFFORT_COUNT && strcmp(text, t3r_effort_name(effort)) != 0) {
        effort++;
    }
    if (effort == T3R_EFFORT_COUNT) {
        argp_error(state, "--%s does not know '%s'; there are fast, balanced, best", option, text);
    }
    const t3r_status status = t3r_set_effort(effort, config, head);
    if (status != T3R_OK) {
        argp_error(state, "--%s %s: %s", option, text, t3r_error_text(status));
    }
}

static void add_method(struct argp_state *state, const char *option, list_word name, method_id methods[METHOD_COUNT],
                       uint32_t *count)
{
    method_id m = method_named(name);
    if (m == METHOD_COUNT) {
        argp_error(state, "--%s: '%.*s' is not a method; there are %s", option, (int)name.length, name.text,
                   METHOD_NAMES);
    }
    for (uint32_t i = 0; i < *count; i++) {
        if (methods[i] == m) {
            argp_error(state, "--%s names %s twice", option, method_name(m));
        }
    }
    methods[(*count)++] = m;
}

void option_methods(struct argp_state *state, const char *option, const char *text, method_id methods[METHOD_COUNT],
                    uint32_t *count)
{
    *count = 0;
    for (list_word w = word_first(text); w.text != NULL; w = word_next(w)) {
        add_method(state, option, w, methods, count);
    }
}
