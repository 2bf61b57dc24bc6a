/* SPDX-License-Identifier: Apache-2.0 */
#include "chunk_packer.h"

#include <stdbool.h>
#include <stdlib.h>

#include <lz4frame.h>
#include <zstd.h>

#define ZSTD_LEVEL 3
#define PIECE_BYTES ((size_t)1 << 20) /* bounds the output room that LZ4 needs for a piece */

const char *const t3r_compression_names[T3R_COMPRESSION_COUNT] = {"none", "zstd", "lz4"};

typedef struct chunk_packer {
    t3r_chunk_packer packer;
    ZSTD_CCtx *zstd;
    LZ4F_cctx *lz4;
    uint8_t *bytes; /* compressed so far */
    size_t count, room;
} chunk_packer;

/* Makes room for `more` bytes. */
static int reserve(chunk_packer *self, size_t more)
{
    if (self->room - self->count >= more) {
        return 0;
    }
    size_t room = self->room * 2 > self->count + more ? self->room * 2 : self->count + more;
    uint8_t *grown = realloc(self->bytes, room);
    if (grown == NULL) {
        return -1;
    }
    self->bytes = grown;
    self->room = room;
    return 0;
}

static int zstd_begin(void *user)
{
    chunk_packer *self = user;
    self->count = 0;
    return ZSTD_isError(ZSTD_CCtx_reset(self->zstd, ZSTD_reset_session_only)) ? -1 : 0;
}

static int zstd_feed(chunk_packer *self, const void *bytes, size_t count, ZSTD_EndDirective directive)
{
    ZSTD_inBuffer in = {bytes, count, 0};
    size_t left = 1;
    while (directive == ZSTD_e_end ? left != 0 : in.pos < in.size) {
        if (reserve(self, ZSTD_CStreamOutSize()) != 0) {
            return -1;
        }
        ZSTD_outBuffer out = {self->bytes, self->room, self->count};
        left = ZSTD_compressStream2(self->zstd, &out, &in, directive);
        if (ZSTD_isError(left)) {
            return -1;
        }
        self->count = out.pos;
    }
    return 0;
}

static int zstd_write(void *user, const void *bytes, size_t count)
{
    return zstd_feed(user, bytes, count, ZSTD_e_continue);
}

static int zstd_end(void *user, const uint8_t **bytes, size_t *count)
{
    chunk_packer *self = user;
    int status = zstd_feed(self, NULL, 0, ZSTD_e_end);
    *bytes = self->bytes;
    *count = self->count;
    return status;
}

/* Counts the bytes that a call added, or reports its error. */
static int lz4_add(chunk_packer *self, size_t added)
{
    self->count += LZ4F_isError(added) ? 0 : added;
    return LZ4F_isError(added) ? -1 : 0;
}

static int lz4_begin(void *user)
{
    chunk_packer *self = user;
    self->count = 0;
    return reserve(self, LZ4F_HEADER_SIZE_MAX) != 0
               ? -1
               : lz4_add(self, LZ4F_compressBegin(self->lz4, self->bytes, self->room, NULL));
}

static int lz4_write(void *user, const void *bytes, size_t count)
{
    chunk_packer *self = user;
    for (size_t at = 0; at < count;) {
        size_t some = count - at < PIECE_BYTES ? count - at : PIECE_BYTES;
        if (reserve(self, LZ4F_compressBound(some, NULL)) != 0 ||
            lz4_add(self, LZ4F_compressUpdate(self->lz4, self->bytes + self->count, self->room - self->count,
                                              (const uint8_t *)bytes + at, some, NULL)) != 0) {
            return -1;
        }
        at += some;
    }
    return 0;
}

static int lz4_end(void *user, const uint8_t **bytes, size_t *count)
{
    chunk_packer *self = user;
    int status = reserve(self, LZ4F_compressBound(0, NULL));
    if (status == 0) {
        status = lz4_add(self, LZ4F_compressEnd(self->lz4, self->bytes + self->count, self->room - self->count, NULL));
    }
    *bytes = self->bytes;
    *count = self->count;
    return status;
}

const t3r_chunk_packer *t3r_chunk_packer_open(t3r_compression compression)
{
    chunk_packer *self = compression == T3R_COMPRESSION_NONE ? NULL : calloc(1, sizeof *self);
    if (self == NULL) {
        return NULL;
    }
    bool zstd = compression == T3R_COMPRESSION_ZSTD;
    self->packer = (t3r_chunk_packer){.name = t3r_compression_names[compression],
                                      .begin = zstd ? zstd_begin : lz4_begin,
                                      .write = zstd ? zstd_write : lz4_write,
                                      .end = zstd ? zstd_end : lz4_end,
                                      .user = self};
    bool made;
    if (zstd) {
        self->zstd = ZSTD_createCCtx();
        made = self->zstd != NULL &&
               !ZSTD_isError(ZSTD_CCtx_setParameter(self->zstd, ZSTD_c_compressionLevel, ZSTD_LEVEL));
    } else {
        made = !LZ4F_isError(LZ4F_createCompressionContext(&self->lz4, LZ4F_VERSION));
    }
    if (!made) {
        t3r_chunk_packer_close(&self->packer);
        return NULL;
    }
    return &self->packer;
}

void t3r_chunk_packer_close(const t3r_chunk_packer *packer)
{
    if (packer != NULL) {
        chunk_packer *self = packer->user;
        ZSTD_freeCCtx(self->zstd);
        LZ4F_freeCompressionContext(self->lz4);
        free(self->bytes);
        free(self);
    }
}
