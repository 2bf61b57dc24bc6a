/* All rows of a command's option tables, those of its children's too, in their order. */
#ifndef TRIM3R_TOOLS_OPTION_LIST_H
#define TRIM3R_TOOLS_OPTION_LIST_H

#include <argp.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct option_row {
    const struct argp_option *option;
    const struct argp *owner; /* whose table it stands in */
    int group;                /* as argp has it: a row without one is in that of the row before */
} option_row;

typedef struct option_list {
    option_row *rows; /* heap; option_list_free() */
    uint32_t count;
} option_list;

/* Ends the process where memory is out. */
option_list option_list_of(const struct argp *argp);
void option_list_free(option_list *list);

/* A row that help shows: an option with a name, no heading. */
bool option_is_shown(const struct argp_option *o);
bool option_has_short(const struct argp_option *o);
/* "-o", or "--csv". */
void option_name(const struct argp_option *o, char name[32]);

#endif
