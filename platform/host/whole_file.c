/* SPDX-License-Identifier: Apache-2.0 */
#include "whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "reason.h"

static int fail(const t3r_whole_file *file, char *error, size_t error_bytes)
{
    return t3r_reason(error, error_bytes, "%s: %s", file->path, strerror(errno));
}

/* Forgets the part, which was renamed or removed. */
static void drop_name(t3r_whole_file *file)
{
    if (file->parts != NULL && file->temporary != NULL) {
        file->parts->forget(file->temporary);
    }
    free(file->temporary);
    file->temporary = NULL;
}

/* Names a part after the process and its count of parts, so that two threads may write one file. Returns false when
 * memory is out. */
static bool name_part(t3r_whole_file *file)
{
    static atomic_uint count;
    const size_t bytes = strlen(file->path) + 48;
    file->temporary = malloc(bytes);
    if (file->temporary == NULL) {
        return false;
    }
    snprintf(file->temporary, bytes, "%s.%ld.%u.part", file->path, (long)getpid(), atomic_fetch_add(&count, 1));
    return true;
}

int t3r_whole_file_begin(t3r_whole_file *file, const char *path, const t3r_part_list *parts, char *error,
                         size_t error_bytes)
{
    *file = (t3r_whole_file){.path = path, .parts = parts};
    struct stat there;
    bool exists = stat(path, &there) == 0;
    bool device = exists && S_ISCHR(there.st_mode);
    if (exists && !device && !S_ISREG(there.st_mode)) {
        /* the rename would replace a pipe by a file */
        return t3r_reason(error, error_bytes, "%s: not a regular file", path);
    }
    int flags = (device ? O_WRONLY : O_RDWR) | O_CLOEXEC; /* a recording's index is read back from the file */
    if (!device) {
        if (!name_part(file)) {
            return fail(file, error, error_bytes);
        }
        if (parts != NULL && !parts->add(file->temporary)) {
            free(file->temporary);
            file->temporary = NULL;
            return t3r_reason(error, error_bytes, "%s: too many files at a time", path);
        }
        /* a link left by an earlier process of this number may lead to another file: the link is removed, its target
         * stays */
        unlink(file->temporary);
        flags |= O_CREAT | O_EXCL | O_NOFOLLOW;
    }
    int descriptor = open(device ? path : file->temporary, flags, 0666);
    file->stream = descriptor >= 0 ? fdopen(descriptor, device ? "wb" : "w+b") : NULL;
    if (file->stream == NULL) {
        fail(file, error, error_bytes);
        if (descriptor >= 0) {
            close(descriptor);
        }
        t3r_whole_file_abandon(file);
        return -1;
    }
    return 0;
}

int t3r_whole_file_commit(t3r_whole_file *file, uint64_t *bytes, char *error, size_t error_bytes)
{
    bool written = fflush(file->stream) == 0 && !ferror(file->stream);
    long length = written && file->temporary != NULL ? ftell(file->stream) : 0;
    written = written && length >= 0;
    if (written) {
        written = fclose(file->stream) == 0;
        file->stream = NULL;
    }
    if (!written || (file->temporary != NULL && rename(file->temporary, file->path) != 0)) {
        fail(file, error, error_bytes);
        t3r_whole_file_abandon(file);
        return -1;
    }
    drop_name(file);
    if (bytes != NULL) {
        *bytes = (uint64_t)length;
    }
    return 0;
}

void t3r_whole_file_abandon(t3r_whole_file *file)
{
    if (file->stream != NULL) {
        fclose(file->stream);
        file->stream = NULL;
    }
    if (file->temporary != NULL) {
        remove(file->temporary);
        drop_name(file);
    }
}
