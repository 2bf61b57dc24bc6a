/* The hash of a stage over serialised bytes (core/hash.h). */
#ifndef T3R_KERNEL_HASH_BYTES_H
#define T3R_KERNEL_HASH_BYTES_H

#include <stddef.h>
#include <stdint.h>

/* Continues `hash` over `count` bytes at any address. */
typedef uint64_t t3r_hash_bytes_kernel(uint64_t hash, const uint8_t *bytes, size_t count);

t3r_hash_bytes_kernel t3r_hash_bytes_c;

#endif
