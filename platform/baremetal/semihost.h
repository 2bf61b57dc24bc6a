/* Semihosting: the files and the console of a debugger, an emulator or a substitute. "Semihosting for AArch32 and
 * AArch64", Arm. */
#ifndef T3R_BAREMETAL_SEMIHOST_H
#define T3R_BAREMETAL_SEMIHOST_H

#include <stddef.h>
#include <stdint.h>

#define SEMIHOST_READ 1u  /* "rb" */
#define SEMIHOST_WRITE 5u /* "wb" */

/* Returns a handle above 0, or -1. */
int32_t semihost_open(const char *path, uint32_t mode);
void semihost_close(int32_t handle);
/* Return 0, or -1 if not all bytes were read or written. */
int semihost_read(int32_t handle, uint32_t offset, void *bytes, size_t count);
int semihost_write(int32_t handle, const void *bytes, size_t count);
/* Returns the size of an open file in bytes, or -1. */
int32_t semihost_length(int32_t handle);

/* Prints text on the host's standard output. */
void semihost_print(const char *text);
/* Copies the command line after the program's name into `text`; returns NULL if there is too little room. */
char *semihost_command_line(char *text, size_t room);
/* Ends the program with this status. */
_Noreturn void semihost_exit(int status);

#endif
