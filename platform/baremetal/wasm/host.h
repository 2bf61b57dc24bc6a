/* The module's imports, which host.mjs provides. */
#ifndef T3R_BAREMETAL_WASM_HOST_H
#define T3R_BAREMETAL_WASM_HOST_H

#include <stdint.h>

#define HOST_IMPORT(name) __attribute__((import_module("host"), import_name(#name)))

/* Semihosting, as in semihost_call.h; the operation that ends the program does not return. */
HOST_IMPORT(semihost) int32_t host_semihost(uint32_t operation, const void *block);
/* Reports that a stage begins; -1: code outside all stages. */
HOST_IMPORT(mark) void host_mark(int32_t stage);

#endif
