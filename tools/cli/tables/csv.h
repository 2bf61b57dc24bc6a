/* Comma-separated tables (RFC 4180, with plain newlines); texts are quoted if necessary. Bytes that csv_read.h refuses,
 * control characters and invalid UTF-8, become '?'. */
#ifndef TRIM3R_TOOLS_CSV_H
#define TRIM3R_TOOLS_CSV_H

#include <stdbool.h>
#include <stdio.h>

typedef struct csv_table {
    FILE *file;
    bool within_row;
} csv_table;

/* Writes the next cell of the row; "" and NULL give an empty cell. */
void csv_cell(csv_table *table, const char *text);
/* Ends the row and passes it to the system, so that interrupted work keeps its finished rows. */
void csv_end_row(csv_table *table);

#endif
