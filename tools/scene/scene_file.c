#include "scene/scene_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/files/whole_file.h"
#include "host/file_bytes.h"
#include "host/reason.h"
#include "scene/scene_format.h"

/* All formats. Of two with one suffix the first is written; `ply` is used for files that no format recognises. */
#ifdef T3R_WEBP
#define FORMATS_OF_WEBP FORMAT(sog)
#else
#define FORMATS_OF_WEBP
#endif
#define FORMATS FORMAT(ply) FORMAT(packed_ply) FORMAT(splat) FORMAT(spz) FORMAT(spz_gzip) FORMAT(glb) FORMATS_OF_WEBP

#define FORMAT(name) extern const scene_format scene_format_##name;
FORMATS
#undef FORMAT

static const scene_format *const formats[] = {
#define FORMAT(name) &scene_format_##name,
    FORMATS
#undef FORMAT
};
enum { FORMATS_COUNT = sizeof formats / sizeof formats[0] };

/* Returns the format with the longest matching suffix. */
static const scene_format *format_of_path(const char *path)
{
    const scene_format *found = NULL;
    const size_t length = strlen(path);
    size_t longest = 0;
    for (int i = 0; i < FORMATS_COUNT; i++) {
        const size_t end = strlen(formats[i]->suffix);
        if (length > end && end > longest && strcmp(path + length - end, formats[i]->suffix) == 0) {
            found = formats[i];
            longest = end;
        }
    }
    return found;
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

/* Finds the format by the first bytes, else by the name. */
static const scene_format *format_of(const char *name, const uint8_t *bytes, size_t count)
{
    const scene_format *format = format_of_bytes(bytes, count);
    format = format != NULL ? format : format_of_path(name);
    return format != NULL ? format : &scene_format_ply;
}

int scene_file_parse(const char *name, const uint8_t *bytes, size_t count, scene_file *out, char *error,
                     size_t error_bytes)
{
    return parse_as(format_of(name, bytes, count), bytes, count, out, error, error_bytes);
}

/* Checks the first bytes before the whole file is read. */
static const char *check_first(const uint8_t *first, size_t count)
{
    return format_of_bytes(first, count) != NULL ? NULL : scene_format_ply.foreign;
}

int scene_file_read(const char *path, scene_file *out, char *error, size_t error_bytes)
{
    *out = (scene_file){0};
    size_t count;
    const scene_format *named = format_of_path(path);
    const bool begins_with_anything = named != NULL && named->magic == NULL && named->parse != NULL;
    uint8_t *bytes =
        t3r_file_bytes_checked(path, SIZE_MAX, begins_with_anything ? NULL : check_first, &count, error, error_bytes);
    if (bytes == NULL) {
        return -1;
    }
    char reason[256] = "";
    int result = scene_file_parse(path, bytes, count, out, reason, sizeof reason);
    if (result != 0) {
        t3r_reason(error, error_bytes, "%s: %s", path, reason);
    }
    free(bytes);
    return result;
}

uint32_t scene_file_degree_most(const char *path)
{
    const scene_format *format = format_of_path(path);
    return format == NULL ? 0 : format->degree;
}

static int write_file(const char *path, const scene_file *scene, int flags, const char *note, char *error,
                      size_t error_bytes)
{
    const scene_format *format = format_of_path(path);
    if (format == NULL || format->write == NULL) {
        char known[SCENE_FILE_SUFFIXES_BYTES];
        return t3r_reason(error, error_bytes, "%s: scenes are written as %s", path, scene_file_suffixes(known));
    }
    scene_source source = {.scene = scene,
                           .flags = flags,
                           .note = note,
                           .turn = scene_turn_to(format->axes, (scene_up)(flags / SCENE_FILE_UP)),
                           .degree = scene->degree < format->degree ? scene->degree : format->degree};
    whole_file file;
    if (whole_file_begin(&file, path, error, error_bytes) != 0) {
        return -1;
    }
    char reason[256] = "";
    if (format->write(file.stream, &source, reason, sizeof reason) != 0) {
        whole_file_abandon(&file);
        return t3r_reason(error, error_bytes, "%s: %s", path, reason);
    }
    return whole_file_commit(&file, NULL, error, error_bytes);
}

int scene_file_write(const char *path, const t3r_scene *scene, int flags, const char *note, char *error,
                     size_t error_bytes)
{
    /* read only */
    const scene_file made = {
        .frame = scene->frame, .gaussians = (t3r_gaussian *)(uintptr_t)scene->gaussians, .count = scene->count};
    return write_file(path, &made, flags, note, error, error_bytes);
}

int scene_file_rewrite(const char *path, const scene_file *scene, int flags, char *error, size_t error_bytes)
{
    return write_file(path, scene, flags, NULL, error, error_bytes);
}
