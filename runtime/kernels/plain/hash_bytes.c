/* SPDX-License-Identifier: Apache-2.0 */
#include "kernels/hash_bytes.h"

#include "core/hash.h"

uint64_t t3r_hash_bytes_c(uint64_t hash, const uint8_t *bytes, size_t count)
{
    return t3r_hash_bytes(hash, bytes, count);
}
