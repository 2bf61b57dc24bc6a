/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/formats/json_stream.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>

void json_stream_begin(json_stream *stream)
{
    *stream = (json_stream){.lost = false};
    stream->file = open_memstream(&stream->text, &stream->bytes);
    stream->lost = stream->file == NULL;
}

void json_stream_put(json_stream *stream, const char *format, ...)
{
    va_list arguments;
    if (stream->lost) {
        return;
    }
    va_start(arguments, format);
    stream->lost = vfprintf(stream->file, format, arguments) < 0;
    va_end(arguments);
}

void json_stream_number(json_stream *stream, double number)
{
    char text[32];
    snprintf(text, sizeof text, "%1.15g", number);
    const double back = strtod(text, NULL);
    if (fabs(back - number) > DBL_EPSILON * fmax(fabs(back), fabs(number))) {
        snprintf(text, sizeof text, "%1.17g", number);
    }
    json_stream_put(stream, "%s", text);
}

void json_stream_numbers(json_stream *stream, const char *name, const double *numbers, uint32_t count)
{
    json_stream_put(stream, "\"%s\":[", name);
    for (uint32_t i = 0; i < count; i++) {
        json_stream_put(stream, "%s", i > 0 ? "," : "");
        json_stream_number(stream, numbers[i]);
    }
    json_stream_put(stream, "]");
}

char *json_stream_end(json_stream *stream)
{
    const bool closed = stream->file != NULL && fclose(stream->file) == 0;
    if (!closed || stream->lost) {
        free(stream->text);
        return NULL;
    }
    return stream->text;
}
