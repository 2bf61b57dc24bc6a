/* SPDX-License-Identifier: Apache-2.0 */
/* The hash of a stage: FNV-1a, 64 bits, over a canonical little-endian serialisation (SPEC.md, "Hash"). */
#ifndef T3R_HASH_H
#define T3R_HASH_H

#include <stddef.h>
#include <stdint.h>

#define T3R_HASH_START UINT64_C(0xcbf29ce484222325)

static inline uint64_t t3r_hash_u8(uint64_t hash, uint8_t byte)
{
    return (hash ^ byte) * UINT64_C(0x100000001b3);
}

static inline uint64_t t3r_hash_u16(uint64_t hash, uint16_t x)
{
    return t3r_hash_u8(t3r_hash_u8(hash, (uint8_t)x), (uint8_t)(x >> 8));
}

static inline uint64_t t3r_hash_u32(uint64_t hash, uint32_t x)
{
    return t3r_hash_u16(t3r_hash_u16(hash, (uint16_t)x), (uint16_t)(x >> 16));
}

static inline uint64_t t3r_hash_u64(uint64_t hash, uint64_t x)
{
    return t3r_hash_u32(t3r_hash_u32(hash, (uint32_t)x), (uint32_t)(x >> 32));
}

static inline uint64_t t3r_hash_bytes(uint64_t hash, const uint8_t *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        hash = t3r_hash_u8(hash, bytes[i]);
    }
    return hash;
}

static inline uint64_t t3r_hash_u16s(uint64_t hash, const uint16_t *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        hash = t3r_hash_u16(hash, values[i]);
    }
    return hash;
}

#endif
