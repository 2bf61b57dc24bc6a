/* The least of each pixel's summed costs, seen from the left and from the right (SPEC.md, "Stereo"). */
#ifndef T3R_KERNEL_WINNER_ROW_H
#define T3R_KERNEL_WINNER_ROW_H

#include <stdint.h>

#include "path_row.h"

typedef struct t3r_winner_row {
    uint32_t width, disparities; /* disparities: a multiple of 16 up to T3R_PATH_MOST */
    const uint8_t *luma;         /* of the left row: pixels of 0 take no part */
    const int16_t *sums;         /* width x disparities, 0 and more */
    uint16_t *first, *second; /* of each left pixel: the first k of the least sum; the least sum but for those of k - 1,
                                 k and k + 1, INT16_MAX where there is no other; of pixels of 0 both 0 */
    int16_t *best,
        *at; /* of each right pixel by falling column, T3R_MATCH_RIGHT(width, disparities) of them: the least sum
                over the left ones that have it for a candidate, INT16_MAX without any, and its least k, or 0 */
} t3r_winner_row;

/* Nothing is aligned beyond its type. */
typedef void t3r_winner_row_kernel(const t3r_winner_row *row);
t3r_winner_row_kernel t3r_winner_row_c;

/* INT16_MAX at k - 1, k and k + 1, 0 elsewhere: from place T3R_PATH_MOST - k on it covers all disparities. */
extern const int16_t t3r_winner_beside[2 * T3R_PATH_MOST];

#endif
