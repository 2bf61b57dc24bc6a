/* SPDX-License-Identifier: Apache-2.0 */
/* The formats of scene files, and which of them a file has. */
#ifndef TRIM3R_TOOLS_SCENE_FORMATS_H
#define TRIM3R_TOOLS_SCENE_FORMATS_H

#include "scene/scene_format.h"

/* Returns the format with the longest matching suffix; NULL: none. */
const scene_format *scene_format_of_path(const char *path);
/* Returns the format that the first bytes identify; NULL: none. */
const scene_format *scene_format_of_bytes(const uint8_t *bytes, size_t count);
/* Returns the format of a file by its first bytes, else by its name, else .ply. */
const scene_format *scene_format_of(const char *name, const uint8_t *bytes, size_t count);
/* Returns an error if the first bytes are of no format that states them; NULL: they are of one. */
const char *scene_format_check(const uint8_t *first, size_t count);

#endif
