/* SPDX-License-Identifier: Apache-2.0 */
/* The interface of a compressor of chunks; chunk_packer.h opens zstd's and LZ4's. */
#ifndef T3R_PLATFORM_PACKER_H
#define T3R_PLATFORM_PACKER_H

#include <stddef.h>
#include <stdint.h>

/* Compresses the records of a chunk, which write() passes piece by piece between begin() and end(). Each returns 0 when
 * done; the output of end() stays valid until the next begin(). */
typedef struct t3r_chunk_packer {
    const char *name; /* MCAP's name: "zstd", "lz4" */
    int (*begin)(void *user);
    int (*write)(void *user, const void *bytes, size_t count);
    int (*end)(void *user, const uint8_t **bytes, size_t *count);
    void *user;
} t3r_chunk_packer;

#endif
