/* Pages for man(1), of the texts that help prints. */
#ifndef TRIM3R_TOOLS_MAN_PAGE_H
#define TRIM3R_TOOLS_MAN_PAGE_H

#include <argp.h>

/* On stdout. The title and the line NAME: "trim3r-build", "turn frames ...". The date is that of SOURCE_DATE_EPOCH, or
 * today's. */
void man_page_begin(const char *name, const char *summary);
void man_page_section(const char *title);
/* Text as help has it: lines that begin with a blank stand as they are, an empty line parts paragraphs. */
void man_page_text(const char *text);
/* An item of a list and what it is. */
void man_page_item(const char *name, const char *text);
/* What every page ends with. */
void man_page_end(void);

/* The page of a command, of its argp: synopsis, description, options, notes, examples. */
void man_page_of_command(const char *command, const char *summary, const struct argp *argp);

#endif
