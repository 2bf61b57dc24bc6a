/* SPDX-License-Identifier: Apache-2.0 */
/* 3DGS .ply, binary little-endian, harmonics of degree 0 to 3. NaN, infinities (except for an opacity of 0 or 1 and a
 * scale of 0), cut files, missing properties and other kinds of .ply are refused with a reason. */
#ifndef TRIM3R_TOOLS_PLY_H
#define TRIM3R_TOOLS_PLY_H

#include <stdio.h>

#include "scene/scene_rows.h"

/* The comment on how many of the last vertices are rim and backdrop; their number follows. */
#define PLY_BACKDROP_COMMENT "comment trim3r backdrop "

/* The comment of Brush for scenes of mip-splatting. Of the comments on this that a file has, the last one counts. */
#define PLY_MIP_COMMENT "comment SplatRenderMode: mip"

/* like scene_format's */
int ply_parse(const uint8_t *bytes, size_t count, const scene_sink *sink, char *error, size_t error_bytes);
int ply_write(FILE *file, const scene_source *source, char *error, size_t error_bytes);

#endif
