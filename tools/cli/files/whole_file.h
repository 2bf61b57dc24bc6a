/* SPDX-License-Identifier: Apache-2.0 */
/* Files of commands that appear under their names only when they are complete (host/whole_file.h). Files that
 * file_guard.h protects are not replaced, and a signal that ends the process leaves no part. Standard output
 * (standard_output.h) is written as it comes. */
#ifndef TRIM3R_TOOLS_WHOLE_FILE_H
#define TRIM3R_TOOLS_WHOLE_FILE_H

#include "host/whole_file.h"

/* Begins a file, like t3r_whole_file_begin(). Returns 0, or -1 with "path: why" in error[]. */
int whole_file_begin(t3r_whole_file *file, const char *path, char *error, size_t error_bytes);

#endif
