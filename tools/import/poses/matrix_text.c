#include "import/poses/matrix_text.h"

#include <stdlib.h>
#include <string.h>

const char *matrix_text_parse(const char *text, double numbers[MATRIX_NUMBERS_MOST], uint32_t *count)
{
    *count = 0;
    for (;;) {
        char *end;
        text += strspn(text, " \t\r\n,");
        if (*text == '\0') {
            return NULL;
        }
        if (*count == MATRIX_NUMBERS_MOST) {
            return "more than 16 numbers";
        }
        numbers[*count] = strtod(text, &end);
        if (end == text || strchr(" \t\r\n,", *end) == NULL) { /* also matches the end of the text */
            return "a word that is no number";
        }
        ++*count;
        text = end;
    }
}
