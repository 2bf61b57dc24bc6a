/* One request to the debugger, the emulator, or what stands for it. */
#ifndef T3R_BAREMETAL_SEMIHOST_CALL_H
#define T3R_BAREMETAL_SEMIHOST_CALL_H

#include <stdint.h>

/* `block` holds the operation's words of 32 bits; what it returns is the operation's, too. */
int32_t semihost_call(uint32_t operation, const void *block);

#endif
