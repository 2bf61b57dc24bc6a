/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/text/word_list.h"

#include <string.h>

list_word word_first(const char *list)
{
    return (list_word){.text = list, .length = list == NULL ? 0 : strcspn(list, ",")};
}

list_word word_next(list_word w)
{
    return word_first(w.text[w.length] == ',' ? w.text + w.length + 1 : NULL);
}

bool word_is(list_word w, const char *name)
{
    return strlen(name) == w.length && strncmp(w.text, name, w.length) == 0;
}
