/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/store/scene_formats.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

/* All formats, and those that need no library, for a module in a page. Of two with one suffix the first is written;
 * `ply` is used for files that no format recognises. */
#ifdef T3R_WEBP
#define FORMATS_OF_WEBP FORMAT(sog)
#else
#define FORMATS_OF_WEBP
#endif
#ifdef T3R_BARE_FORMATS
#define FORMATS FORMAT(ply) FORMAT(packed_ply) FORMAT(splat) FORMAT(spz_bare) FORMAT(glb_bare) FORMAT(sog_bare)
#else
#define FORMATS FORMAT(ply) FORMAT(packed_ply) FORMAT(splat) FORMAT(spz) FORMAT(spz_gzip) FORMAT(glb) FORMATS_OF_WEBP
#endif

#define FORMAT(name) extern const scene_format scene_format_##name;
FORMATS
#undef FORMAT

static const scene_format *const formats[] = {
#define FORMAT(name) &scene_format_##name,
    FORMATS
#undef FORMAT
};
enum { FORMATS_COUNT = sizeof formats / sizeof formats[0] };

const scene_format *scene_format_of_path(const char *path)
{
    const scene_format *found = strcmp(path, "-") == 0 ? &scene_format_ply : NULL; /* standard output */
    const size_t length = strlen(path);
    size_t longest = 0;
    for (int i = 0; i < FORMATS_COUNT; i++) {
        const size_t end = strlen(formats[i]->suffix);
        if (length > end && end > longest && strcasecmp(path + length - end, formats[i]->suffix) == 0) {
            found = formats[i];
            longest = end;
        }
    }
    return found;
}

const scene_format *scene_format_of_bytes(const uint8_t *bytes, size_t count)
{
    for (int i = 0; i < FORMATS_COUNT; i++) {
        const char *magic = formats[i]->magic;
        if (magic != NULL && count >= strlen(magic) && memcmp(bytes, magic, strlen(magic)) == 0) {
            return formats[i];
        }
    }
    return NULL;
}

const scene_format *scene_format_of(const char *name, const uint8_t *bytes, size_t count)
{
    const scene_format *format = scene_format_of_bytes(bytes, count);
    format = format != NULL ? format : scene_format_of_path(name);
    return format != NULL ? format : &scene_format_ply;
}

const char *scene_format_check(const uint8_t *first, size_t count)
{
    return scene_format_of_bytes(first, count) != NULL ? NULL : scene_format_ply.foreign;
}

bool scene_file_is_written(const char *path)
{
    const scene_format *format = scene_format_of_path(path);
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
