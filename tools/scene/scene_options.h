/* The options of the commands that write scenes. */
#ifndef TRIM3R_TOOLS_SCENE_OPTIONS_H
#define TRIM3R_TOOLS_SCENE_OPTIONS_H

#include <argp.h>

/* A usage error where the path (NULL: none) that `option` ("-o") names does not end as scene files that are written. */
void scene_output_option(struct argp_state *state, const char *option, const char *path);
/* --up: the flags of scene_file_write() for the named axis; a usage error for a name that is none. */
int scene_up_option(struct argp_state *state, const char *name);

#endif
