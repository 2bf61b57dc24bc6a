/* SPDX-License-Identifier: Apache-2.0 */
/* Data for the scripts by which shells complete a command's line. */
#ifndef TRIM3R_TOOLS_OPTION_COMPLETION_H
#define TRIM3R_TOOLS_OPTION_COMPLETION_H

#include "cli/options/option_list.h"

/* Prints a line for each option: its name, the kind of its value, and its help, separated by tabs. The first line, with
 * the name *, is for the command's other arguments. Kinds are
 *   nothing         the option has no value
 *   value           no suggestion
 *   on|off          these words, or one alone
 *   file            any file
 *   file:.ply|.spz  files with these endings */
void option_completion_print(const option_list *list, const char *args_doc);

#endif
