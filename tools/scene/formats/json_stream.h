/* SPDX-License-Identifier: Apache-2.0 */
/* JSON that grows as text: whole, or not at all when memory runs out. cJSON would leave items out without a word. */
#ifndef TRIM3R_TOOLS_JSON_STREAM_H
#define TRIM3R_TOOLS_JSON_STREAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct json_stream {
    FILE *file; /* in memory; NULL: memory ran out */
    char *text;
    size_t bytes;
    bool lost; /* memory ran out */
} json_stream;

void json_stream_begin(json_stream *stream);
void json_stream_put(json_stream *stream, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Appends a finite number with 15 digits, or with 17 where 15 are off by more than the last bit, as cJSON does. */
void json_stream_number(json_stream *stream, double number);
/* Appends "name":[1,2,...]. */
void json_stream_numbers(json_stream *stream, const char *name, const double *numbers, uint32_t count);
/* Returns the text; free() it. NULL: memory ran out. */
char *json_stream_end(json_stream *stream);

#endif
