/* The global depth order: a stable radix sort, a byte a pass. */
#include "raster_splat.h"

#include <string.h>

#define DIGITS 4
#define RADIX 256

void t3r_order(uint32_t *keys[2], uint32_t *indices[2], uint32_t count, uint32_t *histogram)
{
    memset(histogram, 0, sizeof *histogram * DIGITS * RADIX);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t digit = 0; digit < DIGITS; digit++) {
            histogram[digit * RADIX + ((keys[0][i] >> (8 * digit)) & 255)]++;
        }
    }
    for (uint32_t digit = 0; digit < DIGITS; digit++) {
        uint32_t *start = histogram + digit * RADIX;
        uint32_t sum = 0;
        for (uint32_t value = 0; value < RADIX; value++) {
            uint32_t here = start[value];
            start[value] = sum;
            sum += here;
        }
        uint32_t from = digit & 1, to = from ^ 1;
        for (uint32_t i = 0; i < count; i++) {
            uint32_t key = keys[from][i];
            uint32_t place = start[(key >> (8 * digit)) & 255]++;
            keys[to][place] = key;
            indices[to][place] = indices[from][i];
        }
    }
}
