/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures and videos that are not read, and the commands that convert them. */
#ifndef TRIM3R_TOOLS_FOREIGN_FILE_H
#define TRIM3R_TOOLS_FOREIGN_FILE_H

#include <stddef.h>
#include <stdint.h>

#define FOREIGN_FILE_BYTES 12u /* bytes that tell the kinds apart */

/* Return "KIND is not read; COMMAND makes ... of it", by a file's first bytes or by its name; NULL for other files. */
const char *foreign_file_of_bytes(const uint8_t *bytes, size_t count);
const char *foreign_file_of_name(const char *name);

#endif
