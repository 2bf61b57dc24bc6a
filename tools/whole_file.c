#include "whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int fail(const whole_file *file, char *error, size_t error_bytes)
{
    snprintf(error, error_bytes, "%s: %s", file->path, strerror(errno));
    return -1;
}

int whole_file_begin(whole_file *file, const char *path, char *error, size_t error_bytes)
{
    size_t bytes = strlen(path) + 32;
    struct stat there;
    if (stat(path, &there) == 0 && !S_ISREG(there.st_mode)) {
        /* the rename would put a file in place of a device or a pipe */
        snprintf(error, error_bytes, "%s: not a regular file", path);
        return -1;
    }
    *file = (whole_file){.path = path, .temporary = malloc(bytes)};
    if (file->temporary == NULL) {
        return fail(file, error, error_bytes);
    }
    snprintf(file->temporary, bytes, "%s.%ld.part", path, (long)getpid());
    int descriptor = open(file->temporary, O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
        file->stream = fdopen(descriptor, "wb");
    }
    if (file->stream == NULL) {
        fail(file, error, error_bytes);
        if (descriptor >= 0) {
            close(descriptor);
            remove(file->temporary);
        }
        free(file->temporary);
        return -1;
    }
    return 0;
}

int whole_file_commit(whole_file *file, uint64_t *bytes, char *error, size_t error_bytes)
{
    long length = fflush(file->stream) == 0 && !ferror(file->stream) ? ftell(file->stream) : -1;
    if (length < 0) {
        fail(file, error, error_bytes);
        whole_file_abandon(file);
        return -1;
    }
    int closed = fclose(file->stream);
    file->stream = NULL;
    if (closed != 0 || rename(file->temporary, file->path) != 0) {
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
