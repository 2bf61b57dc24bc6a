/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/text/wrapped.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define COLUMNS 80u

void wrapped_print(FILE *out, uint32_t indent, const char *label, const char *text)
{
    const size_t label_length = strlen(label);
    size_t column = label_length > indent ? label_length : indent, length;
    fprintf(out, "%-*s", (int)indent, label);
    for (bool first = true; text += strspn(text, " "), (length = strcspn(text, " ")) > 0; text += length) {
        if (!first && column + 1 + length > COLUMNS) {
            fprintf(out, "\n%*s", (int)indent, "");
            column = indent;
        } else if (!first) {
            fputc(' ', out);
            column++;
        }
        fprintf(out, "%.*s", (int)length, text);
        column += length;
        first = false;
    }
    fputc('\n', out);
}

void wrapped_printf(uint32_t indent, const char *label, const char *format, ...)
{
    char *text = NULL;
    size_t bytes;
    FILE *out = open_memstream(&text, &bytes);
    if (out != NULL) {
        va_list arguments;
        va_start(arguments, format);
        vfprintf(out, format, arguments);
        va_end(arguments);
        fclose(out);
    }
    wrapped_print(stdout, indent, label, text != NULL ? text : "out of memory");
    free(text);
}
