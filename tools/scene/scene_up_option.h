/* The option --up of the commands that write scenes. */
#ifndef TRIM3R_TOOLS_SCENE_UP_OPTION_H
#define TRIM3R_TOOLS_SCENE_UP_OPTION_H

#include <argp.h>

/* The flags of scene_file_write() for the named axis; a usage error for a name that is none. */
int scene_up_option(struct argp_state *state, const char *name);

#endif
