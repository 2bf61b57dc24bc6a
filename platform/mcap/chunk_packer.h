/* SPDX-License-Identifier: Apache-2.0 */
/* Compression of chunks, for recorders on machines with a heap (recording.h). chunk_codec.h reads the result. */
#ifndef T3R_PLATFORM_CHUNK_PACKER_H
#define T3R_PLATFORM_CHUNK_PACKER_H

#include <stddef.h>
#include <stdint.h>

/* Compresses the records of a chunk, which write() passes piece by piece between begin() and end(). Each returns 0 when
 * done; the output of end() stays valid until the next begin(). */
typedef struct t3r_chunk_packer {
    const char *name; /* as MCAP names it: "zstd", "lz4" */
    int (*begin)(void *user);
    int (*write)(void *user, const void *bytes, size_t count);
    int (*end)(void *user, const uint8_t **bytes, size_t *count);
    void *user;
} t3r_chunk_packer;

typedef enum t3r_compression {
    T3R_COMPRESSION_NONE,
    T3R_COMPRESSION_ZSTD, /* level 3 */
    T3R_COMPRESSION_LZ4,  /* frames, the fastest level */
    T3R_COMPRESSION_COUNT
} t3r_compression;

/* "none", "zstd", "lz4" */
extern const char *const t3r_compression_names[T3R_COMPRESSION_COUNT];

/* Returns a packer; NULL for NONE, and when memory is out. The same library gives the same bytes for the same input. */
const t3r_chunk_packer *t3r_chunk_packer_open(t3r_compression compression);
/* NULL is allowed. */
void t3r_chunk_packer_close(const t3r_chunk_packer *packer);

#endif
