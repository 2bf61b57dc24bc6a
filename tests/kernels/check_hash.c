/* SPDX-License-Identifier: Apache-2.0 */
/* The hash of a stage. */
#include "checks.h"
#include "guarded.h"

const char *check_hash_bytes(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, 3000);
    const bool is_extreme = unit_random(seed) % 4 == 0;
    const uint64_t start = unit_random(seed);
    uint8_t *bytes = guarded_take(count, 1);
    uint64_t expected = start;
    for (uint32_t i = 0; i < count; i++) {
        bytes[i] = (uint8_t)(is_extreme ? any_value(seed, 0, 255) : unit_between(seed, 0, 255));
        expected = (expected ^ bytes[i]) * UINT64_C(0x100000001b3);
    }
    return kernels->hash_bytes(start, bytes, count) != expected ? "the hash differs" : NULL;
}
