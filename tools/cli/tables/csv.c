#include "cli/tables/csv.h"

#include <string.h>

#include "host/text.h"

/* Writes one character; line ends and tabs unchanged, '?' for each byte of a character that readers of tables refuse.
 * Returns its bytes. */
static size_t put_character(FILE *file, t3r_text text)
{
    const char first = text.chars[0];
    const size_t bytes = t3r_text_character(text);
    if (bytes > 1) {
        fwrite(text.chars, 1, bytes, file);
        return bytes;
    }
    fputc(bytes == 1 || first == '\n' || first == '\r' || first == '\t' ? first : '?', file);
    if (first == '"') {
        fputc('"', file);
    }
    return 1;
}

void csv_cell(csv_table *table, const char *text)
{
    if (table->within_row) {
        fputc(',', table->file);
    }
    table->within_row = true;
    if (text == NULL) {
        return;
    }
    const bool quoted = strpbrk(text, ",\"\r\n") != NULL;
    if (quoted) {
        fputc('"', table->file);
    }
    for (t3r_text rest = t3r_text_of(text); rest.count > 0;) {
        const size_t taken = put_character(table->file, rest);
        rest = (t3r_text){rest.chars + taken, rest.count - taken};
    }
    if (quoted) {
        fputc('"', table->file);
    }
}

void csv_end_row(csv_table *table)
{
    fputc('\n', table->file);
    fflush(table->file);
    table->within_row = false;
}
