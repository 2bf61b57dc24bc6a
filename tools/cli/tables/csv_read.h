/* Comma-separated tables of anyone's making (RFC 4180; lines may also end in a plain newline), read a row at a time. */
#ifndef TRIM3R_TOOLS_CSV_READ_H
#define TRIM3R_TOOLS_CSV_READ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CSV_COLUMNS_MOST 256u
#define CSV_ROW_BYTES_MOST 16384u /* of all cells of a row, an end each included */

typedef struct csv_reader {
    const char *name, *text; /* the caller's; the name is for messages */
    size_t bytes, at;
    uint32_t line, lines_read; /* where the last row began, from 1 on; newlines so far */
    const char *cell[CSV_COLUMNS_MOST];
    uint32_t cell_count;
    char row[CSV_ROW_BYTES_MOST]; /* what the cells point into */
} csv_reader;

/* `text` need not end in a 0. A byte order mark is passed over. */
void csv_reader_open(csv_reader *reader, const char *name, const char *text, size_t bytes);

/* The next row that is not an empty line, as texts in `cell`, valid until the next call: 1, or 0 at the end, or -1 with
 * "name:line: why" in error[]: an open quote, text behind a quoted cell, a control character, bytes that are no
 * printable UTF-8, a row of too many cells or bytes. */
int csv_reader_next(csv_reader *reader, char *error, size_t error_bytes);

/* A finite number in decimal digits, *given = true; of "" and "nan" *given = false. 0, or -1: neither. */
int csv_number(const char *text, double *value, bool *given);

#endif
