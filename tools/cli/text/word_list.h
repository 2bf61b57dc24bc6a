/* SPDX-License-Identifier: Apache-2.0 */
/* The words of a text, separated by commas. */
#ifndef TRIM3R_TOOLS_WORD_LIST_H
#define TRIM3R_TOOLS_WORD_LIST_H

#include <stdbool.h>
#include <stddef.h>

/* A part of the caller's text; text == NULL means after the last word. An empty text holds one empty word. */
typedef struct list_word {
    const char *text;
    size_t length;
} list_word;

list_word word_first(const char *list); /* NULL: no words */
list_word word_next(list_word w);
bool word_is(list_word w, const char *name);

#endif
