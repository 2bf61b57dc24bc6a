/* The least of each pixel's summed costs, for left and right pixels (SPEC.md, "Stereo"). */
#ifndef T3R_KERNEL_WINNER_ROW_H
#define T3R_KERNEL_WINNER_ROW_H

#include <stdint.h>

#include "path_row.h"

typedef struct t3r_winner_row {
    uint32_t width, disparities; /* disparities: a multiple of 16 up to T3R_PATH_MOST */
    const uint8_t *luma;         /* of the left row: pixels without luma are skipped */
    const int16_t *sums;         /* width x disparities, at least 0 */
    uint16_t *first, *second; /* for each left pixel: the first k of the least sum; the least sum except at k - 1, k and
                               * k + 1, INT16_MAX where there is no other; both 0 for pixels without luma */
    int16_t *best,
        *at; /* for each right pixel by falling column, T3R_MATCH_RIGHT(width, disparities) of them: the least sum over
              * the left pixels that have it as a candidate, INT16_MAX without any, and its least k, or 0 */
} t3r_winner_row;

/* Finds the winners of a row. Nothing needs more alignment than its type. */
typedef void t3r_winner_row_kernel(const t3r_winner_row *row);
t3r_winner_row_kernel t3r_winner_row_c;

/* INT16_MAX at k - 1, k and k + 1, 0 elsewhere: from entry T3R_PATH_MOST - k on it covers all disparities. */
extern const int16_t t3r_winner_beside[2 * T3R_PATH_MOST];

#endif
