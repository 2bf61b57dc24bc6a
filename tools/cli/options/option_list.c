/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/option_list.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "cli/options/file_options.h"

static bool ends(const struct argp_option *o)
{
    return o->key == 0 && o->name == NULL && o->doc == NULL && o->group == 0;
}

/* Counts the rows, and writes them if there is room. */
static void add_rows(const struct argp *argp, option_list *list)
{
    for (const struct argp_option *o = argp->options; o != NULL && !ends(o); o++) {
        if (list->rows != NULL) {
            list->rows[list->count] = o;
        }
        list->count++;
    }
    for (const struct argp_child *c = argp->children; c != NULL && c->argp != NULL; c++) {
        add_rows(c->argp, list);
    }
}

option_list option_list_of(const struct argp *argp)
{
    option_list list = {0};
    add_rows(argp, &list);
    list.rows = calloc(list.count + 1, sizeof *list.rows);
    if (list.rows == NULL) {
        exit(cli_error(CLI_BAD_INPUT, "out of memory"));
    }
    list.count = 0;
    add_rows(argp, &list);
    return list;
}

void option_list_free(option_list *list)
{
    free(list->rows);
    *list = (option_list){0};
}

bool option_is_shown(const struct argp_option *o)
{
    return o->name != NULL && o->key != 0 && (o->flags & (OPTION_HIDDEN | OPTION_DOC)) == 0;
}

bool option_has_short(const struct argp_option *o)
{
    return o->key > 0 && o->key < 0x80 && isprint(o->key);
}

void option_name(const struct argp_option *o, char name[32])
{
    if (option_has_short(o)) {
        snprintf(name, 32, "-%c", o->key);
    } else {
        snprintf(name, 32, "--%s", o->name);
    }
}
