/* What the module imports: host.mjs has it. */
#ifndef T3R_BAREMETAL_WASM_HOST_H
#define T3R_BAREMETAL_WASM_HOST_H

#include <stdint.h>

#define HOST_IMPORT(name) __attribute__((import_module("host"), import_name(#name)))

/* Semihosting, as semihost_call.h has it; the end of the program does not return. */
HOST_IMPORT(semihost) int32_t host_semihost(uint32_t operation, const void *block);
/* A stage begins; -1: what belongs to none. */
HOST_IMPORT(mark) void host_mark(int32_t stage);

#endif
