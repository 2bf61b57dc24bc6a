/* SPDX-License-Identifier: Apache-2.0 */
/* The rows of .ply files in other encodings as little-endian bytes. */
#ifndef TRIM3R_TOOLS_PLY_BODY_H
#define TRIM3R_TOOLS_PLY_BODY_H

#include "scene/formats/ply/ply_header.h"

/* Converts the elements before the first one with lists, and moves the header to the new bytes, in which they begin at
 * 0. Returns the bytes, *count of them; free() them. NULL with the reason in error[]. */
uint8_t *ply_body_convert(ply_header *header, const uint8_t *bytes, size_t *count, char *error, size_t error_bytes);

#endif
