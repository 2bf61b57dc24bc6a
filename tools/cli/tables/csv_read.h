/* SPDX-License-Identifier: Apache-2.0 */
/* Reads comma-separated tables from any source (RFC 4180; lines may also end in a plain newline) row by row. */
#ifndef TRIM3R_TOOLS_CSV_READ_H
#define TRIM3R_TOOLS_CSV_READ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CSV_COLUMNS_MOST 256u
#define CSV_ROW_BYTES_MOST 16384u /* all cells of a row, each with its terminator */

typedef struct csv_reader {
    const char *name, *text; /* owned by the caller; the name is for messages */
    size_t bytes, at;
    uint32_t line, lines_read; /* start of the last row, from 1 on; newlines so far */
    const char *cell[CSV_COLUMNS_MOST];
    uint32_t cell_count;
    char row[CSV_ROW_BYTES_MOST]; /* the cells point into it */
} csv_reader;

/* Opens a table; `text` need not end in a 0. A byte order mark is skipped. */
void csv_reader_open(csv_reader *reader, const char *name, const char *text, size_t bytes);

/* Reads the next row that is not empty into `cell`, as texts valid until the next call: 1, or 0 at the end, or -1 with
 * "name:line: why" in error[]: an open quote, text after a quoted cell, a control character, invalid UTF-8, or too
 * many cells or bytes. */
int csv_reader_next(csv_reader *reader, char *error, size_t error_bytes);

/* Parses a finite decimal number, *given = true; for "" and "nan" *given = false. Returns 0, or -1 for other texts. */
int csv_number(const char *text, double *value, bool *given);

#endif
