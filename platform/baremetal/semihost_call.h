/* One request to the debugger, the emulator or a substitute. */
#ifndef T3R_BAREMETAL_SEMIHOST_CALL_H
#define T3R_BAREMETAL_SEMIHOST_CALL_H

#include <stdint.h>

/* The operations that the firmware uses. */
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

/* `block` holds the operation's words, each as large as an address. The meaning of the result depends on the
 * operation. */
int32_t semihost_call(uint32_t operation, const void *block);

#endif
