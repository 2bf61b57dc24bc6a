/* SPDX-License-Identifier: Apache-2.0 */
/* The references between the pictures of a HEIF file, which older versions of libheif follow without an end. */
#ifndef TRIM3R_TOOLS_HEIF_REFERENCES_H
#define TRIM3R_TOOLS_HEIF_REFERENCES_H

#include <stddef.h>
#include <stdint.h>

#define HEIF_REFERENCES_MOST 4096u /* a picture of 16384 x 16384 pixels has tiles of 256 x 256 */
#define HEIF_DEPTH_MOST 8u         /* pictures that consist of pictures, one in another */

/* Returns NULL, or what is wrong: too many references, or a picture that consists of itself. */
const char *heif_references_check(const uint8_t *bytes, size_t count);

#endif
