/* SPDX-License-Identifier: Apache-2.0 */
/* Chunks of a recording are unpacked by the page's scripts (files_chunks.js). */
#include "answer.h"
#include "mcap/chunk_codec.h"

/* Unpacks bytes into memory of `room` bytes, stores how many they are, and returns NULL or what is wrong with them. */
IMPORT(unpack)
extern const char *page_unpack(int32_t is_lz4, const uint8_t *in, size_t in_bytes, uint8_t *out, size_t room,
                               size_t *produced);

bool t3r_chunk_codec_known(t3r_text compression)
{
    return t3r_text_is(compression, "lz4") || t3r_text_is(compression, "zstd");
}

uint64_t t3r_chunk_codec_most(t3r_text compression, size_t in_bytes)
{
    (void)compression;
    (void)in_bytes;
    return UINT64_MAX; /* the reader limits what all chunks may unpack to */
}

const char *t3r_chunk_decompress(t3r_text compression, const uint8_t *in, size_t in_bytes, uint8_t *out, size_t room,
                                 size_t *produced)
{
    return page_unpack(t3r_text_is(compression, "lz4"), in, in_bytes, out, room, produced);
}

bool t3r_zstd_is(const uint8_t *bytes, size_t count)
{
    (void)bytes;
    (void)count;
    return false; /* a packed file is no recording here */
}

uint64_t t3r_zstd_bytes(const uint8_t *bytes, size_t count)
{
    (void)bytes;
    (void)count;
    return 0;
}
