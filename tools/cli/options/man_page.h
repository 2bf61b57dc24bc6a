/* SPDX-License-Identifier: Apache-2.0 */
/* Pages for man(1), made of the help texts. */
#ifndef TRIM3R_TOOLS_MAN_PAGE_H
#define TRIM3R_TOOLS_MAN_PAGE_H

#include <argp.h>

/* Prints on stdout the title and the line NAME: "trim3r-build", "turn frames ...". The date is SOURCE_DATE_EPOCH, or
 * today. */
void man_page_begin(const char *name, const char *summary);
void man_page_section(const char *title);
/* Prints text from help: lines that begin with a blank stay as they are, an empty line separates paragraphs. */
void man_page_text(const char *text);
/* Prints a list item and its description. */
void man_page_item(const char *name, const char *text);
/* Prints the end of every page. */
void man_page_end(void);

/* Prints the page of a command from its argp: synopsis, description, options, notes, examples. */
void man_page_of_command(const char *command, const char *summary, const struct argp *argp);

#endif
