/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures as HEIC or AVIF, by libheif. A build without the library reads none. */
#ifndef TRIM3R_TOOLS_HEIF_H
#define TRIM3R_TOOLS_HEIF_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "pictures/picture.h"

/* Writes the library's name and version. Returns 0, or -1 with the reason in text[] where it is not in this build or
 * does not load. */
int heif_describe(char *text, size_t text_bytes);
/* Whether bytes begin, or a name ends, as pictures that the library reads; never in a build without it. */
bool heif_is(const uint8_t *bytes, size_t count);
bool heif_is_named(const char *name);
/* Reads a picture of 8-bit RGB from a seekable file, upright; with alpha as a fourth channel. header_only: all but the
 * samples. A larger side than most_side is refused. Returns 0, or -1 with the reason in error[] and samples to free. */
int heif_read(FILE *file, uint32_t most_side, bool header_only, picture *out, char *error, size_t error_bytes);

#endif
