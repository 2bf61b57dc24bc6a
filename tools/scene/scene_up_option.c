#include "scene/scene_up_option.h"

#include "scene/scene_file.h"
#include "scene/scene_turn.h"

int scene_up_option(struct argp_state *state, const char *name)
{
    const scene_up up = scene_up_named(name);
    if (up == SCENE_UP_UNKNOWN) {
        argp_error(state, "--up takes one of %s, not '%s'", SCENE_UP_NAMES, name);
    }
    return SCENE_FILE_UP * (int)up;
}
