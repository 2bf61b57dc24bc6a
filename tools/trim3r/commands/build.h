/* SPDX-License-Identifier: Apache-2.0 */
/* The options and the work of `trim3r build`, for any method. */
#ifndef TRIM3R_TOOLS_COMMANDS_BUILD_H
#define TRIM3R_TOOLS_COMMANDS_BUILD_H

#include <argp.h>

#include "reconstruction/method.h"

typedef struct build_options {
    const char *recording;
    const char *output; /* NULL = no scene file */
    const char *colmap; /* NULL = no COLMAP model */
    int flags;          /* SCENE_FILE_... */
    bool profile, json;
    reconstruction_options settings;
} build_options;

/* Before build_argp, which takes build_options *. The method is trim3r. */
void build_defaults(build_options *options);
extern const struct argp build_argp;
/* An exit status of cli.h. */
int build_run(build_options *options);

#endif
