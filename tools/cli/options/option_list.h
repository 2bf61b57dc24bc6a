/* SPDX-License-Identifier: Apache-2.0 */
/* All rows of a command's option tables, including its children's, in order. */
#ifndef TRIM3R_TOOLS_OPTION_LIST_H
#define TRIM3R_TOOLS_OPTION_LIST_H

#include <argp.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct option_list {
    const struct argp_option **rows; /* heap; option_list_free() */
    uint32_t count;
} option_list;

/* Ends the process when memory is out. */
option_list option_list_of(const struct argp *argp);
void option_list_free(option_list *list);

/* Whether help shows a row: an option with a name, no heading. */
bool option_is_shown(const struct argp_option *o);
bool option_has_short(const struct argp_option *o);
/* Writes "-o", or "--csv". */
void option_name(const struct argp_option *o, char name[32]);

#endif
