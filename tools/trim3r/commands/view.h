/* SPDX-License-Identifier: Apache-2.0 */
/* Options and work of `trim3r view`. */
#ifndef TRIM3R_TOOLS_COMMANDS_VIEW_H
#define TRIM3R_TOOLS_COMMANDS_VIEW_H

#include <argp.h>

#include "reconstruction/reconstruction.h"

typedef struct view_options {
    const char *inputs[2];
    const char *scene, *recording; /* which of them is which; NULL = not given */
    const char *output;            /* NULL = the page is served */
    const char *follow;            /* lines of the run that makes the scene; NULL = the scene does not change */
    const char *title;             /* of the page; NULL = the names of the inputs */
    uint16_t port;
    bool json;
    uint32_t compare[T3R_MAX_VIEWS], compare_count;
    reconstruction_options settings;
    /* Called when the first scene is built, in place of the report on the page. Returns an exit status of cli.h. NULL:
     * the report is printed. */
    int (*after)(void *user, const t3r_recording *recording, reconstruction *r, const reconstruction_account *account);
    void *user;
} view_options;

/* Sets defaults for view_argp, which parses into view_options *. */
void view_defaults(view_options *options);
extern const struct argp view_argp;
/* Writes or serves the page; returns an exit status of cli.h. */
int view_run(const view_options *options);

#endif
