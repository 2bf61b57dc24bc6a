/* SPDX-License-Identifier: Apache-2.0 */
/* Turns bytes into a variant of a kernel and its arguments, anything within the ranges of the kernel's header. The
 * result equals plain C, bit for bit, and no byte outside the buffers, which the sanitizer guards, is touched. The
 * checks of tests/kernels make the arguments from the bytes instead of random numbers. */
#include "arguments.h"
#include "host/cpu.h"
#include "kernels/checks.h"
#include "kernels/guarded.h"
#include "kernels/variants.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

static input drawn;

/* Returns four bytes of input in both halves while there are any, then noise. */
uint64_t unit_random(uint64_t *state)
{
    if (drawn.left > 0) {
        return take32(&drawn) * UINT64_C(0x100000001);
    }
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return *state >> 32 | *state << 32;
}

static void *taken[32];
static uint32_t taken_count;

void guarded_begin(uint64_t seed)
{
    (void)seed;
    while (taken_count > 0) {
        free(taken[--taken_count]);
    }
}

/* Returns memory that ends at the allocation's end, with no more than the requested alignment if that is at most 32. */
void *guarded_take(size_t bytes, size_t align)
{
    REQUIRE(taken_count < sizeof taken / sizeof taken[0]);
    REQUIRE(posix_memalign(&taken[taken_count], 64, bytes + align) == 0);
    return (uint8_t *)taken[taken_count++] + align;
}

static void try(const t3r_kernels *kernels, const checked_entry *entry, input from, uint32_t features)
{
    uint64_t seed = from.left;
    drawn = from;
    guarded_begin(0);
    const char *found = entry->check(kernels, &seed);
    if (found != NULL) {
        char set[64];
        t3r_cpu_describe(features, set, sizeof set);
        fprintf(stderr, "%s, %s: %s\n", entry->name, set, found);
        abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    input in = {bytes, count};
    if (T3R_VARIANTS_COUNT == 0 || count == 0) {
        return 0;
    }
    const checked_variant *variant = &checked_variants[take8(&in) % T3R_MAX(T3R_VARIANTS_COUNT, 1)];
    if ((variant->features & ~t3r_cpu_features()) != 0) {
        return 0;
    }
    t3r_kernels kernels;
    t3r_kernels_choose(&kernels, variant->features);
    const checked_entry *entry = checked_entry_named(variant->entry);
    try(&t3r_kernels_c, entry, in, 0);
    try(&kernels, entry, in, variant->features);
    return 0;
}
