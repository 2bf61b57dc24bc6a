/* Comma-separated tables (RFC 4180, with plain newlines): a text that needs it is quoted. Bytes that csv_read.h
 * refuses, control characters and what is not UTF-8, become '?'. */
#ifndef TRIM3R_TOOLS_CSV_H
#define TRIM3R_TOOLS_CSV_H

#include <stdbool.h>
#include <stdio.h>

typedef struct csv_table {
    FILE *file;
    bool within_row;
} csv_table;

/* The next cell of the row; "" and NULL are an empty one. */
void csv_cell(csv_table *table, const char *text);
/* Ends the row and hands it to the system, so that long work leaves what it finished. */
void csv_end_row(csv_table *table);

#endif
