/* Lines of a text that is too large to be held. */
#ifndef TRIM3R_TOOLS_LINE_READER_H
#define TRIM3R_TOOLS_LINE_READER_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#define LINE_READER_BYTES 8192

/* Starts with zeros, but for `file`. */
typedef struct line_reader {
    FILE *file;
    char line[LINE_READER_BYTES]; /* without its end; its first part where `longer` */
    bool longer;                  /* than the room, or with a zero byte */
    uint64_t number, bytes;       /* of lines and bytes up to the end of this one */
} line_reader;

/* The next line; false at the end of the file, where it cannot be read, and behind T3R_LIMIT_MODEL_BYTES. */
bool line_reader_next(line_reader *reader);
/* Whether it ended at that limit. */
bool line_reader_at_limit(const line_reader *reader);

#endif
