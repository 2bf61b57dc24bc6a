#include "cli/csv.h"

#include <string.h>

void csv_cell(csv_table *table, const char *text)
{
    if (table->within_row) {
        fputc(',', table->file);
    }
    table->within_row = true;
    if (text == NULL) {
        return;
    }
    if (strpbrk(text, ",\"\r\n") == NULL) {
        fputs(text, table->file);
        return;
    }
    fputc('"', table->file);
    for (const char *p = text; *p != '\0'; p++) {
        if (*p == '"') {
            fputc('"', table->file);
        }
        fputc(*p, table->file);
    }
    fputc('"', table->file);
}

void csv_end_row(csv_table *table)
{
    fputc('\n', table->file);
    fflush(table->file);
    table->within_row = false;
}
