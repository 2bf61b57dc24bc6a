/* SPDX-License-Identifier: Apache-2.0 */
/* Leaves out the pictures of a posed folder that cannot be read, so that the rest can be imported. */
#ifndef TRIM3R_TOOLS_UNREADABLE_H
#define TRIM3R_TOOLS_UNREADABLE_H

#include <stddef.h>

#include "import/frames/posed_frame.h"

/* Reads every picture once. Drops frames whose picture cannot be read, and their triplets; drops depth that cannot be
 * read. Each is noted with the reason. Returns 0, or -1 with "picture: why" in error[] if no picture, or none of the
 * depth pictures, can be read. */
int unreadable_leave_out(const char *directory, posed_folder *folder, char *error, size_t error_bytes);

#endif
