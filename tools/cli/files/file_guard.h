/* What is never written over: a file that is read, or that another output is. Asked before any work is done, for all
 * files that the command line names, and once more as each file is written: names in folders, numbered ones. */
#ifndef TRIM3R_TOOLS_FILE_GUARD_H
#define TRIM3R_TOOLS_FILE_GUARD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cli/files/file_options.h"

/* Refuses, with a message on stderr and an exit status of cli.h:
 * - an output that is an input or another output, by whatever name or link: bad usage;
 * - an output in the place of a file of another kind, unless `force`, or of what may be read within a folder that is an
 *   input, with `force` too: bad usage;
 * - a path through a folder that is not there: bad input;
 * - inputs and outputs that are no regular files (or folders, where a folder is asked for): bad input. /dev/null and
 *   /dev/full can be written.
 * The files are kept for file_guard_write(), to the process's end. */
int file_guard_begin(named_file *files, uint32_t count, bool force);

/* Refuses an input that is not there. Apart from the former, as a bad value of an option is told first. */
int file_guard_find(void);

/* Whether a file of that path may be written, by the same rules: 0, or -1 with "path: why" in error[]. Before
 * file_guard_begin() everything may. */
int file_guard_write(const char *path, char *error, size_t error_bytes);

#endif
