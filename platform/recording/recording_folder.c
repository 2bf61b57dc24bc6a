/* SPDX-License-Identifier: Apache-2.0 */
#include "recording_folder.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "host/file_bytes.h"
#include "host/grow.h"
#include "host/reason.h"
#include "host/text.h"

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

/* Takes the name out of "- name", "- 'name'" or "- \"name\"". */
static t3r_text name_of(const char *line, size_t bytes)
{
    const size_t skipped = 1 + strspn(line + 1, " \"'");
    size_t end = bytes;
    while (end > skipped && strchr("\"'", line[end - 1]) != NULL) {
        end--;
    }
    return (t3r_text){line + skipped, end > skipped ? end - skipped : 0};
}

/* Adds the items of the list relative_file_paths. Returns -1 without memory. */
static int add_files(const char *folder, const char *text, t3r_recording_files *files)
{
    static const char key[] = "relative_file_paths:";
    const char *line;
    size_t bytes, capacity = 0;
    bool inside = false;
    while (next_line(&text, &line, &bytes)) {
        if (inside && bytes > 2 && line[0] == '-') {
            const t3r_text name = name_of(line, bytes);
            char **grown = t3r_grow(files->paths, files->count, &capacity, sizeof *grown);
            files->paths = grown != NULL ? grown : files->paths;
            char *path = grown != NULL ? joined(folder, name.chars, name.count) : NULL;
            if (path == NULL) {
                return -1;
            }
            files->paths[files->count++] = path;
        } else if (bytes > 0) {
            inside = bytes == sizeof key - 1 && memcmp(line, key, bytes) == 0;
        }
    }
    return 0;
}

static bool ends_with(const char *name, const char *end)
{
    const size_t count = strlen(name), tail = strlen(end);
    return count > tail && strcmp(name + count - tail, end) == 0;
}

/* Returns 0, or -1 with what is wrong with the files: one is in SQLite or is missing. */
static int check_files(const t3r_recording_files *files, char *error, size_t error_bytes)
{
    for (size_t i = 0; i < files->count; i++) {
        const char *path = files->paths[i];
        struct stat about;
        if (ends_with(path, ".db3") || ends_with(path, ".db3.zstd")) {
            const int stem = (int)(strstr(strrchr(path, '/'), ".db3") - path);
            return t3r_reason(error, error_bytes,
                              "%s: a bag in SQLite: %smcap convert %.*s.db3 %.*s.mcap makes an MCAP file of it", path,
                              ends_with(path, "zstd") ? "zstd -d unpacks it, and " : "", stem, path, stem, path);
        }
        if (stat(path, &about) != 0 || !S_ISREG(about.st_mode)) {
            return t3r_reason(error, error_bytes, "%s: file %zu of the %zu that metadata.yaml names is not there", path,
                              i + 1, files->count);
        }
    }
    return 0;
}

static int list_folder(const char *path, t3r_recording_files *out, char *error, size_t error_bytes)
{
    char *list = joined(path, "metadata.yaml", 13);
    size_t bytes;
    uint8_t *text = list == NULL ? NULL : t3r_file_bytes(list, MOST_BYTES, &bytes, error, error_bytes);
    int status = text == NULL ? -1 : 0;
    if (status == 0 && add_files(path, (const char *)text, out) != 0) {
        status = t3r_reason(error, error_bytes, "out of memory");
    } else if (status == 0 && out->count == 0) {
        status = t3r_reason(error, error_bytes, "%s: relative_file_paths names no file", list);
    }
    free(text);
    free(list);
    return status == 0 ? check_files(out, error, error_bytes) : status;
}

int t3r_recording_files_of(const char *path, t3r_recording_files *out, char *error, size_t error_bytes)
{
    *out = (t3r_recording_files){0};
    if (t3r_recording_is_folder(path)) {
        return list_folder(path, out, error, error_bytes);
    }
    out->paths = malloc(sizeof *out->paths);
    char *copy = out->paths != NULL ? strdup(path) : NULL;
    if (copy == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    out->paths[out->count++] = copy;
    return 0;
}

void t3r_recording_files_free(t3r_recording_files *files)
{
    for (size_t i = 0; i < files->count; i++) {
        free(files->paths[i]);
    }
    free(files->paths);
    *files = (t3r_recording_files){0};
}
