/* Exports of Record3D. */
#ifndef TRIM3R_TOOLS_RECORD3D_H
#define TRIM3R_TOOLS_RECORD3D_H

#include <stdbool.h>
#include <stddef.h>

#include "import/folders/posed_frame.h"

bool record3d_is(const char *directory);

/* Of an unpacked .r3d, or of the export with EXR: the pictures with their poses. Depth is read where it is not packed
 * with LZFSE or EXR; otherwise it is left out, which a remark says. */
int record3d_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                  size_t error_bytes);

/* The text of its metadata: lenses and poses of the frames, without names; and the sides of depth, 0 where it has none.
 * 0, or -1 with "field: what" in error[]. posed_folder_close() in either case. */
int record3d_parse(const char *text, size_t bytes, posed_folder *out, uint32_t depth_sides[2], char *error,
                   size_t error_bytes);

#endif
