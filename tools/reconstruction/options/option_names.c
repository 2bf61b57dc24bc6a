/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/options/option_names.h"

#include <string.h>

#include "reconstruction/chosen_head.h"

const char *option_head(struct argp_state *state, const char *option, const char *text)
{
    if (!chosen_head_is_one(text)) {
        argp_error(state, "--%s does not know '%s'; there are " CHOSEN_HEAD_VALUES, option, text);
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

void option_preset(struct argp_state *state, const char *option, const char *text, t3r_config *config,
                   const char **head)
{
    t3r_preset preset = 0;
    while (preset < T3R_PRESET_COUNT && strcmp(text, t3r_preset_name(preset)) != 0) {
        preset++;
    }
    if (preset == T3R_PRESET_COUNT) {
        argp_error(state, "--%s does not know '%s'; there are fast, balanced, best", option, text);
    }
    const t3r_status status = t3r_set_preset(preset, config, head);
    if (status != T3R_OK) {
        argp_error(state, "--%s %s: %s", option, text, t3r_error_text(status));
    }
}
