/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/tables/csv_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "host/reason.h"
#include "host/text.h"

#define NUMBER_MOST 1e15 /* largest number that a chart can use */

void csv_reader_open(csv_reader *reader, const char *name, const char *text, size_t bytes)
{
    *reader = (csv_reader){.name = name, .text = text, .bytes = bytes, .at = t3r_text_mark((t3r_text){text, bytes})};
}

static int fail(const csv_reader *reader, const char *why, char *error, size_t error_bytes)
{
    return t3r_reason(error, error_bytes, "%s:%u: %s", reader->name, (unsigned)reader->line, why);
}

/* State of the row being read in `row`. */
typedef struct row_state {
    size_t used;
    bool quoted; /* inside quotes */
    bool closed; /* after the closing quote of a cell */
    bool begun;  /* the cell has a character or a quote */
} row_state;

static const char *put(csv_reader *reader, row_state *state, const char *bytes, size_t count)
{
    if (state->used + count + 1 > CSV_ROW_BYTES_MOST) {
        return "a row of more than 16384 bytes";
    }
    memcpy(reader->row + state->used, bytes, count);
    state->used += count;
    state->begun = true;
    return NULL;
}

/* Ends the cell that begins at `start`; the next may begin. */
static const char *end_cell(csv_reader *reader, row_state *state, size_t *start)
{
    if (reader->cell_count == CSV_COLUMNS_MOST) {
        return "more than 256 cells in a row";
    }
    if (state->used == CSV_ROW_BYTES_MOST) {
        return "a row of more than 16384 bytes";
    }
    reader->row[state->used++] = '\0';
    reader->cell[reader->cell_count++] = reader->row + *start;
    *start = state->used;
    state->begun = state->closed = false;
    return NULL;
}

/* Takes one character of a cell, quotes included; returns the reason if it is not allowed there. */
static const char *take(csv_reader *reader, row_state *state)
{
    const char *p = reader->text + reader->at;
    const bool is_plain = *p == '\t' || (state->quoted && (*p == '\n' || *p == '\r'));
    const size_t left = reader->bytes - reader->at, count = is_plain ? 1 : t3r_text_character((t3r_text){p, left});
    if (count == 0) {
        return (unsigned char)*p < 0x80 ? "a control character" : "bytes that are no printable UTF-8";
    }
    reader->at += count;
    if (*p == '"' && state->quoted) {
        if (left > 1 && p[1] == '"') {
            reader->at++;
            return put(reader, state, "\"", 1);
        }
        state->quoted = false;
        state->closed = true;
        return NULL;
    }
    if (state->closed) {
        return "text after a quoted cell";
    }
    if (*p == '"') {
        if (state->begun) {
            return "a quote within a cell that did not begin with one";
        }
        state->quoted = state->begun = true;
        return NULL;
    }
    return put(reader, state, p, count);
}

/* Reads to the end of a line; *why = NULL or a reason. */
static void read_row(csv_reader *reader, const char **why)
{
    row_state state = {0};
    size_t start = 0;
    *why = NULL;
    reader->cell_count = 0;
    while (reader->at < reader->bytes && *why == NULL) {
        char c = reader->text[reader->at];
        bool pair = c == '\r' && reader->at + 1 < reader->bytes && reader->text[reader->at + 1] == '\n';
        reader->lines_read += c == '\n';
        if (state.quoted || (c != '\n' && c != ',' && !pair)) {
            *why = take(reader, &state);
            continue;
        }
        reader->at += pair ? 2 : 1;
        reader->lines_read += pair;
        if (c != ',') {
            break;
        }
        *why = end_cell(reader, &state, &start);
    }
    if (*why == NULL && state.quoted) {
        *why = "a quote that is not closed";
    }
    bool empty_line = reader->cell_count == 0 && !state.begun && state.used == 0;
    if (*why == NULL && !empty_line) {
        *why = end_cell(reader, &state, &start);
    }
}

int csv_reader_next(csv_reader *reader, char *error, size_t error_bytes)
{
    while (reader->at < reader->bytes) {
        const char *why;
        reader->line = reader->lines_read + 1;
        read_row(reader, &why);
        if (why != NULL) {
            return fail(reader, why, error, error_bytes);
        }
        if (reader->cell_count > 0) {
            return 1;
        }
    }
    return 0;
}

int csv_number(const char *text, double *value, bool *given)
{
    *given = false;
    *value = NAN;
    if (*text == '\0' || strcasecmp(text, "nan") == 0) {
        return 0;
    }
    /* only digits, sign, point and exponent: strtod() would also take spaces, hexadecimal and infinities */
    char *end;
    double number = strtod(text, &end);
    if (strspn(text, "0123456789.+-eE") != strlen(text) || *end != '\0' || !(fabs(number) <= NUMBER_MOST)) {
        return -1;
    }
    *value = number;
    *given = true;
    return 0;
}
