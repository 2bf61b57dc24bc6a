/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/file_place.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Splits off the path's last part: "a" of "a/b", "/" of "/b", "." of "b". Returns the last part. */
static const char *parent_of(const char *path, size_t length, char folder[PATH_MAX])
{
    size_t start = length;
    while (start > 0 && path[start - 1] != '/') {
        start--;
    }
    size_t end = start;
    while (end > 1 && path[end - 1] == '/') {
        end--;
    }
    memcpy(folder, end == 0 ? "." : path, end == 0 ? 1 : end);
    folder[end == 0 ? 1 : end] = '\0';
    return path + start;
}

file_place file_place_of(const char *path)
{
    struct stat there;
    size_t length = strlen(path);
    if (stat(path, &there) == 0) {
        return (file_place){there.st_mode, there.st_dev, there.st_rdev, there.st_ino, "", 0};
    }
    file_place place = {.below = path, .below_bytes = length};
    while (length > 1 && path[length - 1] == '/') {
        length--;
    }
    const size_t end = length;
    char folder[PATH_MAX];
    while (length > 0 && length < PATH_MAX) {
        const char *last = parent_of(path, length, folder);
        if (stat(folder, &there) == 0) {
            return (file_place){0, there.st_dev, 0, there.st_ino, last, (size_t)(path + end - last)};
        }
        length = last == path ? 0 : strlen(folder);
    }
    return place; /* nothing on the path exists */
}

bool file_place_same(const file_place *a, const file_place *b)
{
    return a->device == b->device && a->inode == b->inode && a->below_bytes == b->below_bytes &&
           memcmp(a->below, b->below, a->below_bytes) == 0;
}

size_t file_place_ends(const char *path, int *error)
{
    char folder[PATH_MAX];
    struct stat there;
    *error = 0;
    for (size_t end = strcspn(path, "/"); path[end] == '/' && end < sizeof folder;) {
        const size_t next = end + strspn(path + end, "/");
        memcpy(folder, path, end);
        folder[end] = '\0';
        if (path[next] == '\0') {
            return 0; /* slashes after the last part */
        }
        if (end > 0 && stat(folder, &there) != 0) {
            *error = errno;
            return end;
        }
        if (end > 0 && !S_ISDIR(there.st_mode)) {
            *error = ENOTDIR;
            return end;
        }
        end = next + strcspn(path + next, "/");
    }
    return 0;
}

bool file_place_dangles(const char *path)
{
    struct stat link, there;
    return lstat(path, &link) == 0 && S_ISLNK(link.st_mode) && stat(path, &there) != 0;
}

bool file_place_beneath(const char *path, const file_place *folder)
{
    char given[PATH_MAX], whole[PATH_MAX];
    struct stat there;
    if (!S_ISDIR(folder->mode) || strlen(path) >= PATH_MAX) {
        return false;
    }
    parent_of(path, strlen(path), given);
    if (realpath(given, whole) == NULL) {
        return false;
    }
    for (;;) {
        if (stat(whole, &there) == 0 && there.st_dev == folder->device && there.st_ino == folder->inode) {
            return true;
        }
        if (strcmp(whole, "/") == 0) {
            return false;
        }
        memcpy(given, whole, strlen(whole) + 1);
        parent_of(given, strlen(given), whole);
    }
}
