/* SPDX-License-Identifier: Apache-2.0 */
/* Keeps commands from overwriting a file that is read or that is another output. Checked before any work, for all files
 * on the command line, and again as each file is written, for names in folders and numbered names. */
#ifndef TRIM3R_TOOLS_FILE_GUARD_H
#define TRIM3R_TOOLS_FILE_GUARD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cli/options/file_options.h"

/* Refuses, with a message on stderr and an exit status of cli.h:
 * - an output that is an input or another output, by whatever name or link: bad usage;
 * - an output that would replace a file of another kind, unless `force`, or a file that may be read within an input
 *   folder, even with `force`: bad usage;
 * - an output whose suffix is that of another kind of file, unless `force`: bad usage;
 * - a path through a missing folder: bad input;
 * - inputs and outputs that are no regular files (or folders, if a folder is expected): bad input. /dev/null and
 *   /dev/full can be written.
 * The files are kept for file_guard_write() until the process ends. */
int file_guard_begin(named_file *files, uint32_t count, bool force);

/* Refuses a missing input. Separate from file_guard_begin(), because a bad option value is reported first. */
int file_guard_find(void);

/* Whether a file of that path may be written, by the same rules: 0, or -1 with "path: why" in error[]. Before
 * file_guard_begin() every file may. */
int file_guard_write(const char *path, char *error, size_t error_bytes);

#endif
