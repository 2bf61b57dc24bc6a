/* SPDX-License-Identifier: Apache-2.0 */
/* Reads lines of a text that is too large for memory. */
#ifndef TRIM3R_TOOLS_LINE_READER_H
#define TRIM3R_TOOLS_LINE_READER_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#define LINE_READER_BYTES 8192

/* Initialise with zeros, except `file`. */
typedef struct line_reader {
    FILE *file;
    char line[LINE_READER_BYTES]; /* without its line end; if `longer`, only its first part */
    bool longer;                  /* longer than the buffer, or contains a zero byte */
    uint64_t number, bytes;       /* count of lines and bytes, including this line */
} line_reader;

/* Reads the next line; false at the end of the file, when it cannot be read, and past T3R_LIMIT_MODEL_BYTES. */
bool line_reader_next(line_reader *reader);
/* Whether reading ended at that limit. */
bool line_reader_at_limit(const line_reader *reader);

#endif
