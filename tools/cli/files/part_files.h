/* SPDX-License-Identifier: Apache-2.0 */
/* Files and folders that are not complete yet. A signal that ends the process (SIGINT, SIGTERM, SIGHUP, SIGQUIT,
 * SIGPIPE) removes them first. */
#ifndef TRIM3R_TOOLS_PART_FILES_H
#define TRIM3R_TOOLS_PART_FILES_H

#include <stdbool.h>

#define PART_FILES_MOST 64 /* at once */

/* Registers `path`, which is or is about to become a part, by reference until part_files_forget(). False: there are too
 * many. */
bool part_files_add(char *path);
void part_files_forget(const char *path);
/* Removes the parts and ends the process with that signal, for handlers of programs that catch it themselves. */
void part_files_end(int signal_number);

#endif
