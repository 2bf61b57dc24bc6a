#include "semihost.h"

#include <string.h>

#include "semihost_call.h"
#include "text_length.h"

enum {
    SYS_OPEN = 0x01,
    SYS_CLOSE = 0x02,
    SYS_WRITE = 0x05,
    SYS_READ = 0x06,
    SYS_SEEK = 0x0a,
    SYS_FLEN = 0x0c,
    SYS_GET_CMDLINE = 0x15,
    SYS_EXIT_EXTENDED = 0x20
};

#define EXIT_REASON 0x20026u /* ADP_Stopped_ApplicationExit */

int32_t semihost_open(const char *path, uint32_t mode)
{
    const uint32_t block[3] = {(uint32_t)(uintptr_t)path, mode, (uint32_t)text_length(path)};
    return semihost_call(SYS_OPEN, block);
}

void semihost_close(int32_t handle)
{
    const uint32_t block[1] = {(uint32_t)handle};
    semihost_call(SYS_CLOSE, block);
}

int semihost_read(int32_t handle, uint32_t offset, void *bytes, size_t count)
{
    const uint32_t seek[2] = {(uint32_t)handle, offset};
    const uint32_t read[3] = {(uint32_t)handle, (uint32_t)(uintptr_t)bytes, (uint32_t)count};
    return semihost_call(SYS_SEEK, seek) == 0 && semihost_call(SYS_READ, read) == 0 ? 0 : -1; /* what is left to read */
}

int semihost_write(int32_t handle, const void *bytes, size_t count)
{
    const uint32_t block[3] = {(uint32_t)handle, (uint32_t)(uintptr_t)bytes, (uint32_t)count};
    return semihost_call(SYS_WRITE, block) == 0 ? 0 : -1;
}

int32_t semihost_length(int32_t handle)
{
    const uint32_t block[1] = {(uint32_t)handle};
    return semihost_call(SYS_FLEN, block);
}

void semihost_print(const char *text)
{
    const int32_t console = semihost_open(":tt", SEMIHOST_WRITE);
    if (console > 0) {
        semihost_write(console, text, text_length(text));
        semihost_close(console);
    }
}

int semihost_command_line(char *text, size_t room)
{
    uint32_t block[2] = {(uint32_t)(uintptr_t)text, (uint32_t)room};
    if (semihost_call(SYS_GET_CMDLINE, block) != 0) {
        return -1;
    }
    const char *behind = text; /* the program's name */
    while (*behind != ' ' && *behind != '\0') {
        behind++;
    }
    behind += *behind == ' ';
    memmove(text, behind, text_length(behind) + 1);
    return 0;
}

_Noreturn void semihost_exit(int status)
{
    const uint32_t block[2] = {EXIT_REASON, (uint32_t)status};
    semihost_call(SYS_EXIT_EXTENDED, block);
    for (;;) {
    }
}
