/* The global depth order: a stable radix sort, a byte a pass. */
#include "raster_splat.h"

#include "core/memory.h"

void t3r_order(const t3r_kernels *kernels, uint32_t *keys[2], uint32_t *indices[2], uint32_t count, uint32_t *histogram)
{
    memset(histogram, 0, sizeof *histogram * T3R_RADIX_DIGITS * T3R_RADIX);
    kernels->radix_count(keys[0], count, histogram);
    for (uint32_t digit = 0; digit < T3R_RADIX_DIGITS; digit++) {
        uint32_t *start = histogram + digit * T3R_RADIX;
        uint32_t sum = 0;
        for (uint32_t value = 0; value < T3R_RADIX; value++) {
            uint32_t here = start[value];
            start[value] = sum;
            sum += here;
        }
        uint32_t from = digit & 1, to = from ^ 1;
        kernels->radix_pass(keys[from], indices[from], count, digit, start, keys[to], indices[to]);
    }
}
