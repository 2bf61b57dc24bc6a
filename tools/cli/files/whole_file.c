/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/files/whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/files/part_files.h"
#include "cli/options/file_guard.h"
#include "host/reason.h"

static int fail(const whole_file *file, char *error, size_t error_bytes)
{
    return t3r_reason(error, error_bytes, "%s: %s", file->path, strerror(errno));
}

/* Forgets the part, which was renamed or removed. */
static void drop_name(whole_file *file)
{
    part_files_forget(file->temporary);
    free(file->temporary);
    file->temporary = NULL;
}

int whole_file_begin(whole_file *file, const char *path, char *error, size_t error_bytes)
{
    *file = (whole_file){.path = path};
    struct stat there;
    bool exists = stat(path, &there) == 0;
    bool device = exists && S_ISCHR(there.st_mode);
    if (exists && !device && !S_ISREG(there.st_mode)) {
        /* the rename would replace a pipe by a file */
        return t3r_reason(error, error_bytes, "%s: not a regular file", path);
    }
    if (file_guard_write(path, error, error_bytes) != 0) {
        return -1;
    }
    int flags = (device ? O_WRONLY : O_RDWR) | O_CLOEXEC; /* a recording's index is read back from the file */
    if (!device) {
        size_t bytes = strlen(path) + 32;
        file->temporary = malloc(bytes);
        if (file->temporary == NULL) {
            return fail(file, error, error_bytes);
        }
        snprintf(file->temporary, bytes, "%s.%ld.part", path, (long)getpid());
        if (!part_files_add(file->temporary)) {
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
        whole_file_abandon(file);
        return -1;
    }
    return 0;
}

int whole_file_commit(whole_file *file, uint64_t *bytes, char *error, size_t error_bytes)
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
        whole_file_abandon(file);
        return -1;
    }
    drop_name(file);
    if (bytes != NULL) {
        *bytes = (uint64_t)length;
    }
    return 0;
}

void whole_file_abandon(whole_file *file)
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
