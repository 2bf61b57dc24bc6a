/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/text/edit_distance.h"

#include <string.h>

#define LONGEST 63u

static uint32_t least(uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t ab = a < b ? a : b;
    return ab < c ? ab : c;
}

/* Computes the table of prefixes row by row (Wagner and Fischer). */
uint32_t edit_distance(const char *a, const char *b)
{
    uint32_t row[LONGEST + 1];
    const size_t long_a = strlen(a), long_b = strlen(b);
    if (long_a > LONGEST || long_b > LONGEST) {
        return UINT32_MAX;
    }
    for (uint32_t k = 0; k <= long_b; k++) {
        row[k] = k;
    }
    for (uint32_t i = 1; i <= long_a; i++) {
        uint32_t diagonal = row[0];
        row[0] = i;
        for (uint32_t k = 1; k <= long_b; k++) {
            const uint32_t above = row[k];
            row[k] = least(above + 1, row[k - 1] + 1, diagonal + (a[i - 1] != b[k - 1]));
            diagonal = above;
        }
    }
    return row[long_b];
}
