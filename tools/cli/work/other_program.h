/* Another program, run to its end for what it prints. */
#ifndef TRIM3R_TOOLS_OTHER_PROGRAM_H
#define TRIM3R_TOOLS_OTHER_PROGRAM_H

#include <stddef.h>

#define OTHER_PROGRAM_BYTES_MOST ((size_t)1 << 20) /* more that it prints is left out */

/* Runs the file `path` with these arguments, the first its name and NULL behind the last, nothing to read, and stderr
 * dropped. Returns its exit status (128 and the signal that ended it) with what it printed in *text, to be freed, a 0
 * behind it; or -1 with "path: why" in error[]: it can't be started, or takes longer than seconds_most, and is ended.
 */
int other_program_run(const char *path, char *const arguments[], double seconds_most, char **text, char *error,
                      size_t error_bytes);

#endif
