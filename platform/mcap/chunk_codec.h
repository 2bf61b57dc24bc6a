/* SPDX-License-Identifier: Apache-2.0 */
/* Decompression of MCAP chunks: "lz4" (frame format) and "zstd"; and of whole files of zstd. Host side. */
#ifndef T3R_PLATFORM_CHUNK_CODEC_H
#define T3R_PLATFORM_CHUNK_CODEC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "host/text.h"

bool t3r_chunk_codec_known(t3r_text compression);
/* Returns the most that in_bytes can decompress to, for checks before memory is allocated. */
uint64_t t3r_chunk_codec_most(t3r_text compression, size_t in_bytes);

/* Decompresses into out[0..room); *produced counts the output, also on failure. Returns NULL, or what went wrong. */
const char *t3r_chunk_decompress(t3r_text compression, const uint8_t *in, size_t in_bytes, uint8_t *out, size_t room,
                                 size_t *produced);

/* Whether a file begins as zstd's. */
bool t3r_zstd_is(const uint8_t *bytes, size_t count);
/* Returns the size that such a file states for what it unpacks to; 0: none. */
uint64_t t3r_zstd_bytes(const uint8_t *bytes, size_t count);

#endif
