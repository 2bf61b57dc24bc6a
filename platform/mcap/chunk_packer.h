/* SPDX-License-Identifier: Apache-2.0 */
/* Compression of chunks, for recorders on machines with a heap (recording.h). chunk_codec.h reads the result. */
#ifndef T3R_PLATFORM_CHUNK_PACKER_H
#define T3R_PLATFORM_CHUNK_PACKER_H

#include "packer.h"

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
/* Closes a packer; NULL is allowed. */
void t3r_chunk_packer_close(const t3r_chunk_packer *packer);

#endif
