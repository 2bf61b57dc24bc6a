/* The global depth order: a stable radix sort, one byte a pass. */
#include "raster_splat.h"

#include "core/memory.h"

/* Turns counts into starts. Returns false when all keys have the same digit, so the pass can be skipped. */
static bool find_starts(uint32_t counts[T3R_RADIX], uint32_t count)
{
    bool differ = true;
    uint32_t sum = 0;
    for (uint32_t value = 0; value < T3R_RADIX; value++) {
        const uint32_t here = counts[value];
        differ = differ && here != count;
        counts[value] = sum;
        sum += here;
    }
    return differ;
}

uint32_t t3r_order(const t3r_kernels *kernels, uint32_t *keys[2], uint32_t *indices[2], uint32_t count,
                   uint32_t *histogram)
{
    memset(histogram, 0, sizeof *histogram * T3R_RADIX_DIGITS * T3R_RADIX);
    kernels->radix_count(keys[0], count, histogram);
    uint32_t from = 0;
    for (uint32_t digit = 0; digit < T3R_RADIX_DIGITS; digit++) {
        uint32_t *start = histogram + digit * T3R_RADIX;
        if (find_starts(start, count)) {
            const uint32_t to = from ^ 1;
            kernels->radix_pass(keys[from], indices[from], count, digit, start, keys[to], indices[to]);
            from = to;
        }
    }
    return from;
}
