/* SPDX-License-Identifier: Apache-2.0 */
/* Implements a debugger's services by an operating system's calls, so that the firmware runs as a program. */
#include "semihost_call.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "semihost.h"

/* Handles are above 0. */
static int file_of(uintptr_t handle)
{
    return (int)handle - 1;
}

static int32_t open_file(const char *path, uintptr_t mode)
{
    if (strcmp(path, ":tt") == 0) {
        return dup(STDOUT_FILENO) + 1;
    }
    const int file = mode == SEMIHOST_READ ? open(path, O_RDONLY) : open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    return file < 0 ? -1 : file + 1;
}

/* Returns the number of bytes that were not read. */
static int32_t read_file(int file, uint8_t *bytes, size_t count)
{
    ssize_t came = 1;
    while (count > 0 && came > 0) {
        came = read(file, bytes, count);
        bytes += came > 0 ? came : 0;
        count -= came > 0 ? (size_t)came : 0;
    }
    return (int32_t)count;
}

/* Returns the number of bytes that were not written. */
static int32_t write_file(int file, const uint8_t *bytes, size_t count)
{
    ssize_t went = 1;
    while (count > 0 && went > 0) {
        went = write(file, bytes, count);
        bytes += went > 0 ? went : 0;
        count -= went > 0 ? (size_t)went : 0;
    }
    return (int32_t)count;
}

static int32_t length_of(int file)
{
    struct stat told;
    return fstat(file, &told) == 0 ? (int32_t)told.st_size : -1;
}

/* Copies the program's arguments, separated by spaces. */
static int32_t command_line(char *text, size_t room)
{
    const int file = open("/proc/self/cmdline", O_RDONLY);
    const size_t bytes = file < 0 ? 0 : room - (size_t)read_file(file, (uint8_t *)text, room);
    close(file);
    if (bytes == 0 || bytes == room) {
        return -1;
    }
    for (size_t i = 0; i + 1 < bytes; i++) {
        text[i] = text[i] == '\0' ? ' ' : text[i];
    }
    text[bytes] = '\0';
    return 0;
}

int32_t semihost_call(uint32_t operation, const void *block)
{
    const uintptr_t *word = block;
    switch (operation) {
    case SYS_OPEN:
        return open_file((const char *)word[0], word[1]);
    case SYS_CLOSE:
        return close(file_of(word[0]));
    case SYS_WRITE:
        return write_file(file_of(word[0]), (const uint8_t *)word[1], word[2]);
    case SYS_READ:
        return read_file(file_of(word[0]), (uint8_t *)word[1], word[2]);
    case SYS_SEEK:
        return lseek(file_of(word[0]), (off_t)word[1], SEEK_SET) < 0 ? -1 : 0;
    case SYS_FLEN:
        return length_of(file_of(word[0]));
    case SYS_GET_CMDLINE:
        return command_line((char *)word[0], word[1]);
    case SYS_EXIT_EXTENDED:
        exit((int)word[1]);
    default:
        return -1;
    }
}
