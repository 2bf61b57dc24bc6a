/* SPDX-License-Identifier: Apache-2.0 */
/* Options and work of `trim3r build`, for any method. */
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
    /* Called in place of the report, while the scene is there. Returns an exit status of cli.h. NULL: the report is
     * printed. */
    int (*after)(void *user, const t3r_recording *recording, reconstruction *r, const reconstruction_account *account);
    void *user;
} build_options;

/* Sets defaults for build_argp, which parses into build_options *. The method is trim3r. */
void build_defaults(build_options *options);
extern const struct argp build_argp;
/* Builds; returns an exit status of cli.h. */
int build_run(build_options *options);

#endif
