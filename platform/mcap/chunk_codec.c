/* SPDX-License-Identifier: Apache-2.0 */
#include "chunk_codec.h"

#include <lz4frame.h>
#include <string.h>
#include <zstd.h>

static const char *const cut_short = "its compressed data are cut short";
static const char *const too_long = "its data are longer than its uncompressed_size";
static const char *const no_memory = "out of memory";

#define WINDOW_LOG_MOST 26 /* 64 MiB besides the output; frames that declare their size need no window */

bool t3r_chunk_codec_known(t3r_text compression)
{
    return t3r_text_is(compression, "lz4") || t3r_text_is(compression, "zstd");
}

uint64_t t3r_chunk_codec_most(t3r_text compression, size_t in_bytes)
{
    /* LZ4: a byte of input extends a match by at most 255. Zstandard: a block of 4 bytes gives at most 128 KiB. */
    uint64_t ratio = t3r_text_is(compression, "lz4") ? 255 : 32768;
    return in_bytes > UINT64_MAX / ratio ? UINT64_MAX : in_bytes * ratio;
}

static const char *decompress_zstd(const uint8_t *in, size_t in_bytes, uint8_t *out, size_t room, size_t *produced)
{
    ZSTD_DStream *stream = ZSTD_createDStream();
    if (stream == NULL || ZSTD_isError(ZSTD_DCtx_setParameter(stream, ZSTD_d_windowLogMax, WINDOW_LOG_MOST))) {
        ZSTD_freeDStream(stream);
        return no_memory;
    }
    ZSTD_inBuffer input = {in, in_bytes, 0};
    ZSTD_outBuffer output = {out, room, 0};
    const char *wrong = NULL;
    size_t left = 1; /* 0 = a frame has just ended */
    while (wrong == NULL && (input.pos < input.size || left != 0)) {
        size_t in_before = input.pos, out_before = output.pos;
        left = ZSTD_decompressStream(stream, &output, &input);
        if (ZSTD_isError(left)) {
            wrong = ZSTD_getErrorName(left);
        } else if (left != 0 && input.pos == in_before && output.pos == out_before) {
            wrong = input.pos == input.size && output.pos < output.size ? cut_short : too_long;
        }
    }
    *produced = output.pos;
    ZSTD_freeDStream(stream);
    return wrong;
}

static const char *decompress_lz4(const uint8_t *in, size_t in_bytes, uint8_t *out, size_t room, size_t *produced)
{
    LZ4F_dctx *context;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) {
        return no_memory;
    }
    const char *wrong = NULL;
    size_t read = 0, written = 0;
    size_t left = 1;
    while (wrong == NULL && (read < in_bytes || left != 0)) {
        size_t taken = in_bytes - read, given = room - written;
        left = LZ4F_decompress(context, out + written, &given, in + read, &taken, NULL);
        if (LZ4F_isError(left)) {
            wrong = LZ4F_getErrorName(left);
        } else if (left != 0 && taken == 0 && given == 0) {
            wrong = read == in_bytes && written < room ? cut_short : too_long;
        }
        read += LZ4F_isError(left) ? 0 : taken;
        written += LZ4F_isError(left) ? 0 : given;
    }
    *produced = written;
    LZ4F_freeDecompressionContext(context);
    return wrong;
}

const char *t3r_chunk_decompress(t3r_text compression, const uint8_t *in, size_t in_bytes, uint8_t *out, size_t room,
                                 size_t *produced)
{
    return t3r_text_is(compression, "lz4") ? decompress_lz4(in, in_bytes, out, room, produced)
                                           : decompress_zstd(in, in_bytes, out, room, produced);
}

bool t3r_zstd_is(const uint8_t *bytes, size_t count)
{
    static const uint8_t magic[4] = {0x28, 0xb5, 0x2f, 0xfd};
    return count >= sizeof magic && memcmp(bytes, magic, sizeof magic) == 0;
}

uint64_t t3r_zstd_bytes(const uint8_t *bytes, size_t count)
{
    const unsigned long long stated = ZSTD_getFrameContentSize(bytes, count);
    return stated == ZSTD_CONTENTSIZE_UNKNOWN || stated == ZSTD_CONTENTSIZE_ERROR ? 0 : stated;
}
