/* Files and folders that are not whole yet. A signal that ends the process (SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE)
 * removes them first. */
#ifndef TRIM3R_TOOLS_PART_FILES_H
#define TRIM3R_TOOLS_PART_FILES_H

#include <stdbool.h>

#define PART_FILES_MOST 64 /* at a time */

/* `path` is, or is about to become, a part: kept by reference until part_files_forget(). False: there are too many. */
bool part_files_add(char *path);
void part_files_forget(const char *path);
/* Ends the process by that signal, without parts. For handlers of those who caught it themselves. */
void part_files_end(int signal_number);

#endif
