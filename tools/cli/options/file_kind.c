/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/file_kind.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#define LOOKED_AT 512 /* bytes */

static const struct {
    file_kind kind;
    const char *name, *ending, *begins; /* first bytes, in either case of letters, ? any; NULL = see below */
    bool by_name;                       /* other kinds begin the same way: the name must also have the suffix */
} kinds[] = {
    {FILE_RECORDING, "a recording", ".mcap", "\x89MCAP0\r\n", false},
    {FILE_SCENE, "a scene", ".ply", "ply", false},
    {FILE_SCENE, "a scene", ".spz", "NGSP", false},
    {FILE_SCENE, "a scene", ".spz", "\x1f\x8b", true},
    {FILE_SCENE, "a scene", ".glb", "glTF", false},
    {FILE_SCENE, "a scene", ".sog", "PK\x03\x04", true},
    {FILE_SCENE, "a scene", ".splat", "", true},
    {FILE_PICTURE, "a PNG picture", ".png", "\x89PNG\r\n\x1a\n", false},
    {FILE_SVG, "an SVG picture", ".svg", "<svg", false},
    {FILE_SVG, "an SVG picture", ".svg", "<?xml", false},
    {FILE_PAGE, "a page", ".html", "<!DOCTYPE html", false},
    {FILE_WEIGHTS, "a weight file", ".t3w", "T3RW", false},
    {FILE_SOURCE, "the C source of a head", ".c", "/* The head `", false},
    {FILE_LINES, "lines of a stream", ".jsonl", "{\"frame\":", false},
    {FILE_STATE, "the state of a stream", ".t3s", "T3RSTATE", false},
    {FILE_HEADER, "the C header of a plan", ".h", "/* The settings and the static memory", false},
    {FILE_VIDEO, "a video", ".mp4", "????ftyp", false},
    {FILE_VIDEO, "a video", ".mov", "????ftyp", false},
    {FILE_VIDEO, "a video", ".mkv", "\x1a\x45\xdf\xa3", false},
    {FILE_VIDEO, "a video", ".webm", "\x1a\x45\xdf\xa3", false},
    {FILE_TABLE, "a table", ".csv", NULL, false},
    {FILE_OTHER, "a file of another kind", NULL, NULL, false},
};
enum { ROWS = sizeof kinds / sizeof kinds[0] };

/* Suffixes of other kinds, which no picture, scene, page or table is written for. */
static const char *const others[] = {".jpg", ".jpeg", ".webp", ".gif", ".bmp",
                                     ".tif", ".tiff", ".exr",  ".pdf", ".json"};
enum { OTHERS = sizeof others / sizeof others[0] };

/* Returns the dot of the suffix, or NULL. */
static const char *ending_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    return dot != NULL && dot > slash ? dot : NULL;
}

static bool ends_with(const char *path, const char *wanted)
{
    const char *ending = ending_of(path);
    return wanted != NULL && ending != NULL && strcasecmp(ending, wanted) == 0;
}

/* Whether a text begins with a line of column names separated by commas, as the tables of eval and stress do. */
static bool is_heading(const char *text)
{
    size_t length = strspn(text, "abcdefghijklmnopqrstuvwxyz0123456789_,");
    bool ends = text[length] == '\n' || text[length] == '\r' || text[length] == '\0';
    return ends && memchr(text, ',', length) != NULL;
}

/* Whether the bytes at `text`, of which there are enough, are those of a kind. */
static bool begins_with(const char *text, const char *begins)
{
    bool same = true;
    for (; same && *begins != '\0'; text++, begins++) {
        same = *begins == '?' || tolower((unsigned char)*text) == tolower((unsigned char)*begins);
    }
    return same;
}

file_kind file_kind_of(const char *path)
{
    char text[LOOKED_AT + 1] = "";
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    ssize_t count = file < 0 ? -1 : read(file, text, LOOKED_AT);
    const int why = errno;
    if (file >= 0) {
        close(file);
    }
    if (count == 0 || (file < 0 && why == ENOENT)) {
        return 0;
    }
    for (int i = 0; i < ROWS && count > 0; i++) {
        if (kinds[i].begins != NULL && begins_with(text, kinds[i].begins) &&
            (!kinds[i].by_name || ends_with(path, kinds[i].ending))) {
            return kinds[i].kind;
        }
    }
    return count > 0 && is_heading(text) ? FILE_TABLE : FILE_OTHER;
}

file_kind file_kind_named(const char *path)
{
    for (int i = 0; i < ROWS; i++) {
        if (ends_with(path, kinds[i].ending)) {
            return kinds[i].kind;
        }
    }
    for (int i = 0; i < OTHERS; i++) {
        if (ends_with(path, others[i])) {
            return FILE_OTHER;
        }
    }
    return 0;
}

const char *file_kind_ending(file_kind set, int index)
{
    for (int i = 0; i < ROWS; i++) {
        if ((kinds[i].kind & set) != 0 && kinds[i].ending != NULL && index-- == 0) {
            return kinds[i].ending;
        }
    }
    return NULL;
}

const char *file_kind_name(file_kind kind)
{
    int i = 0;
    while (i + 1 < ROWS && kinds[i].kind != kind) {
        i++;
    }
    return kinds[i].name;
}
