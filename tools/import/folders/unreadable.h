/* Pictures of a posed folder that cannot be read: the rest of the folder is still worth having. */
#ifndef TRIM3R_TOOLS_UNREADABLE_H
#define TRIM3R_TOOLS_UNREADABLE_H

#include <stddef.h>

#include "import/folders/posed_frame.h"

/* Reads every picture once. A frame whose picture cannot be read is left out, and triplets with it; depth that cannot
 * be read is forgotten. Each is noted with the reason. 0, or -1 with "picture: why" in error[] where no picture can be
 * read, or no depth of those that there are. */
int unreadable_leave_out(const char *directory, posed_folder *folder, char *error, size_t error_bytes);

#endif
