/* SPDX-License-Identifier: Apache-2.0 */
/* Runs another program to its end for its output. */
#ifndef TRIM3R_TOOLS_OTHER_PROGRAM_H
#define TRIM3R_TOOLS_OTHER_PROGRAM_H

#include <stddef.h>

#define OTHER_PROGRAM_BYTES_MOST ((size_t)1 << 20) /* further output is dropped */

/* Runs the file `path` with these arguments, the first its name and NULL at the end, with no input and stderr dropped.
 * Returns its exit status (128 + the signal that ended it) with its output, followed by a 0, in *text, to be freed; or
 * -1 with "path: why" in error[]: it cannot be started, or is ended because it takes longer than seconds_most. */
int other_program_run(const char *path, char *const arguments[], double seconds_most, char **text, char *error,
                      size_t error_bytes);

#endif
