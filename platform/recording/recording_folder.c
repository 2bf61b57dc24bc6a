/* SPDX-License-Identifier: Apache-2.0 */
#include "recording_folder.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "host/file_bytes.h"
#include "host/reason.h"

#define MOST_BYTES ((size_t)16 << 20) /* of metadata.yaml, which describes every topic of every file */

static char *joined(const char *folder, const char *name, size_t name_bytes)
{
    const size_t bytes = strlen(folder) + name_bytes + 2;
    char *path = malloc(bytes);
    if (path != NULL) {
        snprintf(path, bytes, "%s/%.*s", folder, (int)name_bytes, name);
    }
    return path;
}

bool t3r_recording_is_folder(const char *path)
{
    struct stat about;
    char *list = joined(path, "metadata.yaml", 13);
    const bool is = list != NULL && stat(path, &about) == 0 && S_ISDIR(about.st_mode) && stat(list, &about) == 0 &&
                    S_ISREG(about.st_mode);
    free(list);
    return is;
}

/* Takes the next line without blanks around it; false at the end. */
static bool next_line(const char **at, const char **line, size_t *bytes)
{
    if (**at == '\0') {
        return false;
    }
    const size_t whole = strcspn(*at, "\n");
    *line = *at + strspn(*at, " \t");
    const char *end = *at + whole;
    *at += whole + ((*at)[whole] == '\n' ? 1 : 0);
    while (end > *line && (end[-1] == ' ' || end[-1] == '\r')) {
        end--;
    }
    *bytes = end > *line ? (size_t)(end - *line) : 0;
    return true;
}

/* Finds the first item of the list relative_file_paths, and counts its items. */
static size_t files_of(const char *text, const char **name, size_t *name_bytes)
{
    static const char key[] = "relative_file_paths:";
    const char *line;
    size_t bytes, count = 0;
    bool inside = false;
    while (next_line(&text, &line, &bytes)) {
        if (inside && bytes > 2 && line[0] == '-') {
            const size_t skipped = 1 + strspn(line + 1, " \"'");
            size_t end = bytes;
            while (end > skipped && strchr("\"'", line[end - 1]) != NULL) {
                end--;
            }
            if (count++ == 0 && end > skipped) {
                *name = line + skipped;
                *name_bytes = end - skipped;
            }
        } else if (bytes > 0) {
            inside = bytes == sizeof key - 1 && memcmp(line, key, bytes) == 0;
        }
    }
    return count;
}

static bool ends_with(const char *name, size_t bytes, const char *end)
{
    const size_t tail = strlen(end);
    return bytes > tail && memcmp(name + bytes - tail, end, tail) == 0;
}

char *t3r_recording_folder_file(const char *path, char *error, size_t error_bytes)
{
    char *list = joined(path, "metadata.yaml", 13);
    size_t bytes, name_bytes = 0;
    uint8_t *text = list == NULL ? NULL : t3r_file_bytes(list, MOST_BYTES, &bytes, error, error_bytes);
    free(list);
    if (text == NULL) {
        return NULL;
    }
    const char *name = "";
    char *file = NULL;
    const size_t count = files_of((const char *)text, &name, &name_bytes);
    if (count == 0 || name_bytes == 0) {
        t3r_reason(error, error_bytes, "%s/metadata.yaml: relative_file_paths names no file", path);
    } else if (ends_with(name, name_bytes, ".db3")) {
        t3r_reason(error, error_bytes,
                   "%s: a bag in SQLite (.db3): mcap convert FILE.db3 FILE.mcap makes an MCAP file of each", path);
    } else if (ends_with(name, name_bytes, ".zstd")) {
        t3r_reason(error, error_bytes, "%s: its files are packed with zstd: zstd -d FILE.mcap.zstd -o FILE.mcap", path);
    } else if (count > 1) {
        t3r_reason(error, error_bytes, "%s: a bag of %zu files: mcap merge %s/*.mcap -o FILE.mcap makes one of them",
                   path, count, path);
    } else if ((file = joined(path, name, name_bytes)) == NULL) {
        t3r_reason(error, error_bytes, "out of memory");
    }
    free(text);
    return file;
}
