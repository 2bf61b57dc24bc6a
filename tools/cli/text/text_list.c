/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/text/text_list.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/text/wrapped.h"
#include "host/text.h"

#define LINE_BYTES 1024

int text_list_add(text_list *list, const char *format, ...)
{
    char line[LINE_BYTES];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    t3r_text_clean(line);
    if ((list->count & (list->count - 1)) == 0) { /* doubles at powers of two */
        char **grown = realloc(list->lines, (list->count == 0 ? 1 : (size_t)list->count * 2) * sizeof *grown);
        if (grown == NULL) {
            return -1;
        }
        list->lines = grown;
    }
    char *copy = strdup(line);
    if (copy == NULL) {
        return -1;
    }
    list->lines[list->count++] = copy;
    return 0;
}

void text_list_free(text_list *list)
{
    for (uint32_t i = 0; i < list->count; i++) {
        free(list->lines[i]);
    }
    free(list->lines);
    *list = (text_list){0};
}

void text_list_print(const text_list *list, const char *what)
{
    for (uint32_t i = 0; i < list->count; i++) {
        wrapped_printf(2, what, ": %s", list->lines[i]);
    }
}

void text_list_add_json(const text_list *list, cJSON *object, const char *key)
{
    cJSON *array = cJSON_AddArrayToObject(object, key);
    for (uint32_t i = 0; i < list->count; i++) {
        cJSON_AddItemToArray(array, cJSON_CreateString(list->lines[i]));
    }
}
