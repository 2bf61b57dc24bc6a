/* A recording or a bag of others, written anew: frames whole and indexed, images decoded, poses composed, depth
 * registered, what a cut left mended. */
#ifndef TRIM3R_TOOLS_RECORDING_IMPORT_H
#define TRIM3R_TOOLS_RECORDING_IMPORT_H

#include "cli/options/recording_options.h"
#include "import/bags/bag_options.h"
#include "import/poses/poses.h"

typedef struct recording_import_request {
    const char *input, *output, *source; /* source: what the new one says that it was made of */
    poses_source poses;
    const bag_options *bag;
    const recording_options *stored;
    bool json;
} recording_import_request;

/* Writes it and prints what was made of what. An exit status of cli.h. */
int recording_import(const recording_import_request *request);

#endif
