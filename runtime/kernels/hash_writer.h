/* SPDX-License-Identifier: Apache-2.0 */
/* Serialises values little-endian into the hash of a stage (SPEC.md, "Hash"), a run of bytes at a time. */
#ifndef T3R_HASH_WRITER_H
#define T3R_HASH_WRITER_H

#include "core/hash.h"
#include "core/little_endian.h"
#include "core/memory.h"
#include "kernels/hash_bytes.h"

/* Bytes of a run, which kernels hash fastest, and the most that are written at once */
#define T3R_HASH_RUN 512u

typedef struct t3r_hash_writer {
    t3r_hash_bytes_kernel *hash_bytes;
    uint64_t hash;  /* of all bytes before the buffered ones */
    uint32_t count; /* number of buffered bytes */
    uint8_t bytes[2 * T3R_HASH_RUN];
} t3r_hash_writer;

static inline void t3r_hash_begin(t3r_hash_writer *w, t3r_hash_bytes_kernel *hash_bytes)
{
    w->hash_bytes = hash_bytes;
    w->hash = T3R_HASH_START;
    w->count = 0;
}

/* Returns the hash of all bytes written. */
static inline uint64_t t3r_hash_end(t3r_hash_writer *w)
{
    w->hash = w->hash_bytes(w->hash, w->bytes, w->count);
    w->count = 0;
    return w->hash;
}

/* Returns room for `bytes` more bytes, at most a run. */
static inline uint8_t *t3r_hash_room(t3r_hash_writer *w, uint32_t bytes)
{
    if (w->count >= T3R_HASH_RUN) {
        w->hash = w->hash_bytes(w->hash, w->bytes, T3R_HASH_RUN);
        w->count -= T3R_HASH_RUN;
        memcpy(w->bytes, w->bytes + T3R_HASH_RUN, w->count);
    }
    uint8_t *room = w->bytes + w->count;
    w->count += bytes;
    return room;
}

static inline void t3r_write_u8(t3r_hash_writer *w, uint8_t x)
{
    *t3r_hash_room(w, 1) = x;
}

static inline void t3r_write_u16(t3r_hash_writer *w, uint16_t x)
{
    t3r_store_le16(t3r_hash_room(w, 2), x);
}

static inline void t3r_write_u32(t3r_hash_writer *w, uint32_t x)
{
    t3r_store_le32(t3r_hash_room(w, 4), x);
}

static inline void t3r_write_u64(t3r_hash_writer *w, uint64_t x)
{
    t3r_write_u32(w, (uint32_t)x);
    t3r_write_u32(w, (uint32_t)(x >> 32));
}

static inline void t3r_write_bytes(t3r_hash_writer *w, const uint8_t *bytes, size_t count)
{
    w->hash = w->hash_bytes(t3r_hash_end(w), bytes, count);
}

static inline void t3r_write_u16s(t3r_hash_writer *w, const uint16_t *values, size_t count)
{
    for (size_t i = 0; i < count;) {
        const uint32_t run = (uint32_t)(count - i < T3R_HASH_RUN / 2 ? count - i : T3R_HASH_RUN / 2);
        uint8_t *room = t3r_hash_room(w, 2 * run);
        for (uint32_t j = 0; j < run; j++) {
            t3r_store_le16(room + 2 * (size_t)j, values[i + j]);
        }
        i += run;
    }
}

#endif
