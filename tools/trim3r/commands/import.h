/* SPDX-License-Identifier: Apache-2.0 */
/* Options and work of `trim3r import`. */
#ifndef TRIM3R_TOOLS_COMMANDS_IMPORT_H
#define TRIM3R_TOOLS_COMMANDS_IMPORT_H

#include <argp.h>
#include <stdbool.h>
#include <stdint.h>

#include "cli/options/recording_options.h"
#include "import/bags/bag_options.h"
#include "import/pointmaps/import_pointmaps.h"
#include "import/poses/intrinsics.h"
#include "posing/estimate.h"

typedef struct import_options {
    const char *directory;
    const char *output;
    uint32_t width, height; /* 0 = as the pictures are */
    double intrinsics[INTRINSICS_NUMBERS];
    uint32_t intrinsics_count; /* 0 = not given */
    poses_source poses;
    pointmap_options pointmaps;
    bool keeps_border;
    bool json;
    bag_options bag;
    recording_options stored;
    /* Called in place of the report, with the folder as it was imported, and an account per frame if poses were
     * estimated from pictures. For a bag or a recording both are NULL. NULL: the report is printed. */
    void (*after)(void *user, const posed_folder *folder, const pose_account *accounts);
    void *user;
} import_options;

/* Sets defaults for import_argp, which parses into import_options *. */
void import_defaults(import_options *options);
extern const struct argp import_argp;
/* Imports; returns an exit status of cli.h. */
int import_run(const import_options *options);

#endif
