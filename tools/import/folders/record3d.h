/* SPDX-License-Identifier: Apache-2.0 */
/* Exports of Record3D. */
#ifndef TRIM3R_TOOLS_RECORD3D_H
#define TRIM3R_TOOLS_RECORD3D_H

#include <stdbool.h>
#include <stddef.h>

#include "import/frames/posed_frame.h"

bool record3d_is(const char *directory);

/* Reads an unpacked .r3d, or the export with EXR: the pictures with their poses. Depth that is packed with LZFSE, or
 * EXR that this build cannot read, is left out with a remark. */
int record3d_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                  size_t error_bytes);

/* Parses the text of its metadata: lenses and poses of the frames, without names; and the sides of depth, 0 if it has
 * none. Returns 0, or -1 with "field: what" in error[]. Call posed_folder_close() in either case. */
int record3d_parse(const char *text, size_t bytes, posed_folder *out, uint32_t depth_sides[2], char *error,
                   size_t error_bytes);

#endif
