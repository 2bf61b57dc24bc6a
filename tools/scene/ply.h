/* 3DGS .ply, binary little-endian, degree 0 of its harmonics. NaN, infinities (but those of an opacity of 0 or 1 and of
 * a scale of 0), cut files, missing properties and other kinds of .ply are refused with a reason. */
#ifndef TRIM3R_TOOLS_PLY_H
#define TRIM3R_TOOLS_PLY_H

#include <stdio.h>

#include "scene/scene_file.h"

/* As scene_format has them. */
int ply_parse(const uint8_t *bytes, size_t count, scene_file *out, char *error, size_t error_bytes);
void ply_write(FILE *file, const t3r_scene *scene, int flags, const char *note);

#endif
