#include "cli/files/whole_folder.h"

#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/files/part_files.h"
#include "host/reason.h"

#define PART ".part"

static int fail(const whole_folder *folder, char *error, size_t error_bytes)
{
    return t3r_reason(error, error_bytes, "%s: %s", folder->path, strerror(errno));
}

/* Whether an entry is ".", "..", or the hidden folder of a killed process. */
static bool is_nothing(const char *name)
{
    size_t length = strlen(name);
    return strcmp(name, ".") == 0 || strcmp(name, "..") == 0 ||
           (name[0] == '.' && length > strlen(PART) && strcmp(name + length - strlen(PART), PART) == 0);
}

static bool is_empty(const char *path)
{
    DIR *folder = opendir(path);
    bool empty = true;
    for (const struct dirent *entry; folder != NULL && empty && (entry = readdir(folder)) != NULL;) {
        empty = is_nothing(entry->d_name);
    }
    if (folder != NULL) {
        closedir(folder);
    }
    return empty;
}

/* Keeps the path, from malloc(), of what is made next; NULL with a reason. */
static char *keep(whole_folder *folder, char *path, char *error, size_t error_bytes)
{
    if (path == NULL || folder->count > WHOLE_FOLDER_MOST || !part_files_add(path)) {
        t3r_reason(error, error_bytes, "%s: %s", folder->path,
                   path == NULL ? "out of memory" : "too many files at a time");
        free(path);
        return NULL;
    }
    folder->made[folder->count++] = path;
    return path;
}

/* Returns "folder/name", from malloc(). */
static char *path_in(const char *folder, const char *name)
{
    size_t bytes = strlen(folder) + strlen(name) + 2;
    char *path = malloc(bytes);
    if (path != NULL) {
        snprintf(path, bytes, "%s/%s", folder, name);
    }
    return path;
}

/* Returns the temporary path, from malloc(); another one for each `attempt`. */
static char *part_path(const whole_folder *folder, int attempt)
{
    size_t length = strlen(folder->path), bytes = length + 64;
    while (length > 1 && folder->path[length - 1] == '/') {
        length--;
    }
    char *path = malloc(bytes);
    if (path != NULL) {
        snprintf(path, bytes, "%.*s%s.%ld-%d" PART, (int)length, folder->path, folder->within ? "/" : "",
                 (long)getpid(), attempt);
    }
    return path;
}

static int make(whole_folder *folder, char *path, char *error, size_t error_bytes)
{
    path = keep(folder, path, error, error_bytes);
    return path == NULL ? -1 : mkdir(path, 0777) == 0 ? 0 : fail(folder, error, error_bytes);
}

int whole_folder_make(whole_folder *folder, const char *name, char *error, size_t error_bytes)
{
    return make(folder, path_in(folder->made[0], name), error, error_bytes);
}

int whole_folder_begin(whole_folder *folder, const char *path, char *error, size_t error_bytes)
{
    struct stat there;
    *folder = (whole_folder){.path = path, .within = stat(path, &there) == 0};
    if (folder->within && !S_ISDIR(there.st_mode)) {
        return t3r_reason(error, error_bytes, "%s: %s", path, strerror(ENOTDIR));
    }
    if (!is_empty(path)) {
        return t3r_reason(error, error_bytes, "%s: the folder is not empty", path);
    }
    /* a killed process of the same number may have left one */
    for (int attempt = 0; attempt < 100; attempt++) {
        errno = 0;
        if (make(folder, part_path(folder, attempt), error, error_bytes) == 0) {
            return 0;
        }
        const bool taken = errno == EEXIST;
        whole_folder_abandon(folder);
        if (!taken) {
            break;
        }
    }
    return -1;
}

const char *whole_folder_file(whole_folder *folder, const char *name, char *error, size_t error_bytes)
{
    return keep(folder, path_in(folder->made[0], name), error, error_bytes);
}

static void forget(whole_folder *folder)
{
    while (folder->count > 0) {
        char *path = folder->made[--folder->count];
        (void)remove(path);
        part_files_forget(path);
        free(path);
    }
}

/* Moves the top entries into the existing folder, or back again. */
static bool move_all(const whole_folder *folder, bool back)
{
    bool moved = true;
    size_t prefix = strlen(folder->made[0]) + 1;
    for (uint32_t i = 1; i < folder->count && (moved || back); i++) {
        const char *from = folder->made[i];
        if (strchr(from + prefix, '/') == NULL) {
            char *to = path_in(folder->path, from + prefix);
            moved = to != NULL && (back ? rename(to, from) : rename(from, to)) == 0;
            free(to);
        }
    }
    return moved;
}

int whole_folder_commit(whole_folder *folder, char *error, size_t error_bytes)
{
    /* all or nothing: signals are blocked meanwhile */
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    bool moved = folder->within ? move_all(folder, false) : rename(folder->made[0], folder->path) == 0;
    int status = moved ? 0 : fail(folder, error, error_bytes);
    if (!moved && folder->within) {
        (void)move_all(folder, true);
    }
    forget(folder); /* the moved entries no longer have these names */
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return status;
}

void whole_folder_abandon(whole_folder *folder)
{
    forget(folder);
}
