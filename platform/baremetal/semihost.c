#include "semihost.h"

#include <string.h>

#include "semihost_call.h"
#include "text_length.h"

#define EXIT_REASON 0x20026u /* ADP_Stopped_ApplicationExit */

int32_t semihost_open(const char *path, uint32_t mode)
{
    const uintptr_t block[3] = {(uintptr_t)path, mode, text_length(path)};
    return semihost_call(SYS_OPEN, block);
}

void semihost_close(int32_t handle)
{
    const uintptr_t block[1] = {(uintptr_t)handle};
    semihost_call(SYS_CLOSE, block);
}

int semihost_read(int32_t handle, uint32_t offset, void *bytes, size_t count)
{
    const uintptr_t seek[2] = {(uintptr_t)handle, offset};
    const uintptr_t read[3] = {(uintptr_t)handle, (uintptr_t)bytes, count};
    return semihost_call(SYS_SEEK, seek) == 0 && semihost_call(SYS_READ, read) == 0
               ? 0
               : -1; /* 0: no bytes are left to read */
}

int semihost_write(int32_t handle, const void *bytes, size_t count)
{
    const uintptr_t block[3] = {(uintptr_t)handle, (uintptr_t)bytes, count};
    return semihost_call(SYS_WRITE, block) == 0 ? 0 : -1;
}

int32_t semihost_length(int32_t handle)
{
    const uintptr_t block[1] = {(uintptr_t)handle};
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

char *semihost_command_line(char *text, size_t room)
{
    uintptr_t block[2] = {(uintptr_t)text, room};
    if (semihost_call(SYS_GET_CMDLINE, block) != 0) {
        return NULL;
    }
    char *behind = text; /* end of the program's name */
    while (*behind != ' ' && *behind != '\0') {
        behind++;
    }
    return *behind == ' ' ? behind + 1 : behind;
}

_Noreturn void semihost_exit(int status)
{
    const uintptr_t block[2] = {EXIT_REASON, (uintptr_t)status};
    semihost_call(SYS_EXIT_EXTENDED, block);
    for (;;) {
    }
}
