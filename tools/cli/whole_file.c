#include "cli/whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "reason.h"

static int fail(const whole_file *file, char *error, size_t error_bytes)
{
    return t3r_reason(error, error_bytes, "%s: %s", file->path, strerror(errno));
}

int whole_file_begin(whole_file *file, const char *path, char *error, size_t error_bytes)
{
    *file = (whole_file){.path = path};
    struct stat there;
    bool exists = stat(path, &there) == 0;
    bool device = exists && S_ISCHR(there.st_mode);
    if (exists && !device && !S_ISREG(there.st_mode)) {
        /* the rename would put a file in place of a pipe */
        return t3r_reason(error, error_bytes, "%s: not a regular file", path);
    }
    int flags = O_WRONLY | O_CLOEXEC;
    if (!device) {
        size_t bytes = strlen(path) + 32;
        file->temporary = malloc(bytes);
        if (file->temporary == NULL) {
            return fail(file, error, error_bytes);
        }
        snprintf(file->temporary, bytes, "%s.%ld.part", path, (long)getpid());
        flags |= O_CREAT | O_TRUNC | O_NOFOLLOW;
    }
    int descriptor = open(device ? path : file->temporary, flags, 0666);
    file->stream = descriptor >= 0 ? fdopen(descriptor, "wb") : NULL;
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
    free(file->temporary);
    file->temporary = NULL;
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
        free(file->temporary);
        file->temporary = NULL;
    }
}
