/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_options.h"

#include "scene/scene_file.h"
#include "scene/scene_turn.h"

void scene_output_option(struct argp_state *state, const char *option, const char *path)
{
    char suffixes[SCENE_FILE_SUFFIXES_BYTES];
    if (path != NULL && !scene_file_is_written(path)) {
        argp_error(state, "%s %s: scenes are written as %s", option, path, scene_file_suffixes(suffixes));
    }
}

int scene_up_option(struct argp_state *state, const char *name)
{
    const scene_up up = scene_up_named(name);
    if (up == SCENE_UP_UNKNOWN) {
        argp_error(state, "--up takes one of %s, not '%s'", SCENE_UP_NAMES, name);
    }
    return SCENE_FILE_UP * (int)up;
}
