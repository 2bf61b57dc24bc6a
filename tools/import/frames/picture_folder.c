/* SPDX-License-Identifier: Apache-2.0 */
/* A folder that holds only pictures. */
#define _GNU_SOURCE /* versionsort() */
#include "import/frames/picture_folder.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "host/reason.h"
#include "mcap/reader_limits.h"
#include "pictures/foreign_file.h"
#include "pictures/heif.h"

static int is_picture(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');
    return entry->d_name[0] != '.' && dot != NULL &&
           (strcasecmp(dot, ".png") == 0 || strcasecmp(dot, ".jpg") == 0 || strcasecmp(dot, ".jpeg") == 0 ||
            heif_is_named(dot));
}

static int is_foreign(const struct dirent *entry)
{
    return entry->d_name[0] != '.' && foreign_file_of_name(entry->d_name) != NULL;
}

int picture_folder_foreign(const char *directory, left_out *out)
{
    struct dirent **entries;
    const int count = scandir(directory, &entries, is_foreign, versionsort);
    int status = 0;
    for (int i = 0; i < count; i++) {
        const char *name = entries[i]->d_name;
        status = status == 0 ? text_list_add(&out->frames, "%s: %s", name, foreign_file_of_name(name)) : status;
        free(entries[i]);
    }
    if (count >= 0) {
        free(entries);
    }
    return status;
}

static int is_bag(const struct dirent *entry)
{
    static const char *const endings[] = {".mcap", ".zstd", ".db3", ".bag"};
    const char *dot = strrchr(entry->d_name, '.');
    bool is = false;
    for (size_t i = 0; i < sizeof endings / sizeof *endings && dot != NULL; i++) {
        is = is || strcasecmp(dot, endings[i]) == 0;
    }
    return is;
}

/* Returns the first of such entries, on the heap; NULL: there is none. */
static char *first_of(const char *directory, int (*is)(const struct dirent *))
{
    struct dirent **entries;
    char *name = NULL;
    const int count = scandir(directory, &entries, is, versionsort);
    for (int i = 0; i < count; i++) {
        name = i == 0 ? strdup(entries[i]->d_name) : name;
        free(entries[i]);
    }
    if (count >= 0) {
        free(entries);
    }
    return name;
}

bool picture_folder_is(const char *directory)
{
    char *shown = first_of(directory, is_picture);
    const bool is = shown != NULL;
    free(shown);
    return is;
}

char *picture_folder_bag(const char *directory)
{
    return picture_folder_is(directory) ? NULL : first_of(directory, is_bag);
}

static int is_visible(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

char *picture_folder_below(const char *directory)
{
    struct dirent **entries;
    char *found = NULL;
    const int count = scandir(directory, &entries, is_visible, versionsort);
    for (int i = 0; i < count; i++) {
        char *path = found == NULL ? posed_path(directory, entries[i]->d_name) : NULL;
        if (path != NULL && picture_folder_is(path)) {
            found = path;
        } else {
            free(path);
        }
        free(entries[i]);
    }
    if (count >= 0) {
        free(entries);
    }
    return found;
}

int picture_folder_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                        size_t error_bytes)
{
    struct dirent **entries;
    memset(out, 0, sizeof *out);
    out->kind = "pictures";
    out->depth_unit = 0.001;
    if (picture_folder_foreign(directory, &out->left_out) != 0) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    int count = scandir(directory, &entries, is_picture, versionsort);
    if (count < 0) {
        return t3r_reason(error, error_bytes, "%s: %s", directory, strerror(errno));
    }
    out->frames = calloc((size_t)count + 1, sizeof *out->frames);
    int status = 0;
    if (count == 0 || count > T3R_LIMIT_FRAMES) {
        status = t3r_reason(
            error, error_bytes, "%s: %s", directory,
            count == 0 && out->left_out.frames.count > 0 ? out->left_out.frames.lines[0]
            : count == 0 ? "no pictures, no transforms.json, no rgb.txt and groundtruth.txt: name a folder of photos"
                         : T3R_LIMIT_TEXT("more than ", T3R_LIMIT_FRAMES, " pictures"));
    }
    for (int i = 0; i < count; i++) {
        if (status == 0 && out->frames != NULL) {
            posed_frame *frame = &out->frames[out->frame_count++];
            frame->image = strdup(entries[i]->d_name);
            frame->intrinsics =
                options->intrinsics != NULL ? posed_intrinsics_of(options->intrinsics) : posed_intrinsics_unknown();
            frame->pose = rigid_identity;
            status = frame->image != NULL ? 0 : t3r_reason(error, error_bytes, "out of memory");
        }
        free(entries[i]);
    }
    free(entries);
    return out->frames != NULL ? status : t3r_reason(error, error_bytes, "out of memory");
}

static int by_text(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Returns the entry's path as frames spell it, on the heap. */
static char *spelled(const char *place, const char *name)
{
    const size_t bytes = strlen(place) + strlen(name) + 2;
    char *path = malloc(bytes);
    if (path != NULL) {
        snprintf(path, bytes, "%s/%s", place, name);
    }
    return path;
}

int picture_folder_rest(const char *directory, const char *place, const char *why, posed_folder *out, char *error,
                        size_t error_bytes)
{
    struct dirent **entries = NULL;
    char *folder = posed_path(directory, place);
    const char **used = malloc((out->frame_count + 1) * sizeof *used);
    const int count = folder == NULL ? -1 : scandir(folder, &entries, is_picture, versionsort);
    int status = folder != NULL && used != NULL ? 0 : t3r_reason(error, error_bytes, "out of memory");
    for (uint32_t i = 0; i < out->frame_count && status == 0; i++) {
        used[i] = out->frames[i].image;
    }
    if (status == 0) {
        qsort(used, out->frame_count, sizeof *used, by_text);
    }
    for (int i = 0; i < count; i++) {
        char *path = status == 0 ? spelled(place, entries[i]->d_name) : NULL;
        if (status == 0 && (path == NULL || (bsearch(&path, used, out->frame_count, sizeof *used, by_text) == NULL &&
                                             text_list_add(&out->left_out.frames, "%s: %s", path, why) != 0))) {
            status = t3r_reason(error, error_bytes, "out of memory");
        }
        free(path);
        free(entries[i]);
    }
    free(entries);
    free(used);
    free(folder);
    return status;
}
