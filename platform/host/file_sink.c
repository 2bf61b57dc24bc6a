/* SPDX-License-Identifier: Apache-2.0 */
#include "sink.h"

#include <stdbool.h>
#include <stdio_ext.h>
#include <sys/stat.h>

static int append(void *user, const void *bytes, size_t count)
{
    return fwrite(bytes, 1, count, user) == count ? 0 : -1;
}

static int read_back(void *user, uint64_t offset, void *bytes, size_t count)
{
    FILE *file = user;
    bool read = fseeko(file, (off_t)offset, SEEK_SET) == 0 && fread(bytes, 1, count, file) == count;
    return fseeko(file, 0, SEEK_END) == 0 && read ? 0 : -1;
}

static bool can_be_read_back(FILE *file)
{
    int descriptor = fileno(file); /* -1: a stream in memory */
    struct stat about;
    return descriptor >= 0 && __freadable(file) && fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode);
}

t3r_sink t3r_file_sink(FILE *file)
{
    return (t3r_sink){append, file, can_be_read_back(file) ? read_back : NULL};
}
