#include "scene/scene_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/whole_file.h"
#include "file_bytes.h"
#include "reason.h"
#include "scene/scene_format.h"

/* Every format, the first for files that none of them knows. */
#define FORMATS FORMAT(ply)

#define FORMAT(name) extern const scene_format scene_format_##name;
FORMATS
#undef FORMAT

static const scene_format *const formats[] = {
#define FORMAT(name) &scene_format_##name,
    FORMATS
#undef FORMAT
};
enum { FORMATS_COUNT = sizeof formats / sizeof formats[0] };

static const scene_format *format_of_path(const char *path)
{
    size_t length = strlen(path);
    for (int i = 0; i < FORMATS_COUNT; i++) {
        size_t end = strlen(formats[i]->suffix);
        if (length > end && strcmp(path + length - end, formats[i]->suffix) == 0) {
            return formats[i];
        }
    }
    return NULL;
}

static const scene_format *format_of_bytes(const uint8_t *bytes, size_t count)
{
    for (int i = 0; i < FORMATS_COUNT; i++) {
        const char *magic = formats[i]->magic;
        if (magic != NULL && count >= strlen(magic) && memcmp(bytes, magic, strlen(magic)) == 0) {
            return formats[i];
        }
    }
    return NULL;
}

bool scene_file_is_read(const char *path)
{
    const scene_format *format = format_of_path(path);
    return format != NULL && format->parse != NULL;
}

bool scene_file_is_written(const char *path)
{
    const scene_format *format = format_of_path(path);
    return format != NULL && format->write != NULL;
}

const char *scene_file_suffixes(char text[SCENE_FILE_SUFFIXES_BYTES])
{
    size_t length = 0;
    for (int i = 0; i < FORMATS_COUNT; i++) {
        if (formats[i]->write != NULL && length < SCENE_FILE_SUFFIXES_BYTES) {
            length += (size_t)snprintf(text + length, SCENE_FILE_SUFFIXES_BYTES - length, "%s%s",
                                       length > 0 ? ", " : "", formats[i]->suffix);
        }
    }
    return text;
}

static int parse_as(const scene_format *format, const uint8_t *bytes, size_t count, scene_file *out, char *error,
                    size_t error_bytes)
{
    *out = (scene_file){0};
    return format->parse == NULL ? t3r_reason(error, error_bytes, "%s is written, not read", format->suffix)
                                 : format->parse(bytes, count, out, error, error_bytes);
}

int scene_file_parse(const uint8_t *bytes, size_t count, scene_file *out, char *error, size_t error_bytes)
{
    const scene_format *format = format_of_bytes(bytes, count);
    return parse_as(format != NULL ? format : formats[0], bytes, count, out, error, error_bytes);
}

/* Before the whole of a file is read. */
static const char *check_first(const uint8_t *first, size_t count)
{
    bool any = false;
    for (int i = 0; i < FORMATS_COUNT; i++) {
        any = any || formats[i]->magic == NULL;
    }
    return any || format_of_bytes(first, count) != NULL ? NULL : formats[0]->foreign;
}

int scene_file_read(const char *path, scene_file *out, char *error, size_t error_bytes)
{
    *out = (scene_file){0};
    size_t count;
    uint8_t *bytes = t3r_file_bytes_checked(path, SIZE_MAX, check_first, &count, error, error_bytes);
    if (bytes == NULL) {
        return -1;
    }
    const scene_format *format = format_of_bytes(bytes, count);
    format = format != NULL ? format : format_of_path(path);
    format = format != NULL ? format : formats[0];
    char reason[256] = "";
    int result = parse_as(format, bytes, count, out, reason, sizeof reason);
    if (result != 0) {
        t3r_reason(error, error_bytes, "%s: %s", path, reason);
    }
    free(bytes);
    return result;
}

int scene_file_write(const char *path, const t3r_scene *scene, int flags, const char *note, char *error,
                     size_t error_bytes)
{
    const scene_format *format = format_of_path(path);
    if (format == NULL || format->write == NULL) {
        char known[SCENE_FILE_SUFFIXES_BYTES];
        return t3r_reason(error, error_bytes, "%s: scenes are written as %s", path, scene_file_suffixes(known));
    }
    whole_file file;
    if (whole_file_begin(&file, path, error, error_bytes) != 0) {
        return -1;
    }
    format->write(file.stream, scene, flags, note);
    return whole_file_commit(&file, NULL, error, error_bytes);
}
