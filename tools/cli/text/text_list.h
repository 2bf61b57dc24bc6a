/* SPDX-License-Identifier: Apache-2.0 */
/* Lines of text to print at the end of a command. */
#ifndef TRIM3R_TOOLS_TEXT_LIST_H
#define TRIM3R_TOOLS_TEXT_LIST_H

#include <stdint.h>

#include <cjson/cJSON.h>

/* Initialise with zeros. */
typedef struct text_list {
    char **lines;
    uint32_t count;
} text_list;

/* Adds a line, cleaned and cut like reasons (reason.h). Returns 0, or -1 when out of memory. */
int text_list_add(text_list *list, const char *format, ...) __attribute__((format(printf, 2, 3)));
void text_list_free(text_list *list);
/* Prints "what: line" for each line on stdout. */
void text_list_print(const text_list *list, const char *what);
void text_list_add_json(const text_list *list, cJSON *object, const char *key);

#endif
