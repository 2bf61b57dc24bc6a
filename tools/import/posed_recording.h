/* A recording once more, with other poses. */
#ifndef TRIM3R_TOOLS_POSED_RECORDING_H
#define TRIM3R_TOOLS_POSED_RECORDING_H

#include <stdio.h>

#include "cli/recording_options.h"
#include "recording.h"

/* Writes all frames of a recording, with the poses that they have now (t3r_recording_set_pose()), in the format and
 * with the stamps, depth, intrinsics and triplets that they came with. source: what the new one says that it was made
 * from. 0, or -1 with "frame N: why" in error[]. */
int posed_recording_write(const t3r_recording *recording, const char *source, const recording_options *stored,
                          FILE *stream, char *error, size_t error_bytes);

#endif
