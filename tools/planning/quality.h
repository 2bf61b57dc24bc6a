/* SPDX-License-Identifier: Apache-2.0 */
/* Loss of a new view against the best settings measured, in 1/16 dB of PSNR, by head, passes of refinement and
 * percent of the points kept: docs/study/cost.md. tools/study/scripts/cost --write makes this file. */
#ifndef TRIM3R_TOOLS_QUALITY_H
#define TRIM3R_TOOLS_QUALITY_H

#include <stdint.h>

#define QUALITY_HEADS 3
#define QUALITY_PASSES 6
#define QUALITY_SHARES 7

static const uint8_t quality_passes[QUALITY_PASSES] = {0, 1, 2, 4, 8, 16};
static const uint8_t quality_percent[QUALITY_SHARES] = {100, 50, 20, 10, 5, 2, 1};

/* analytic, tiny, small */
static const uint8_t quality_loss_q4[QUALITY_HEADS][QUALITY_PASSES][QUALITY_SHARES] = {
    {{90, 91, 101, 113, 131, 167, 195},
     {52, 56, 62, 72, 91, 122, 152},
     {35, 39, 50, 56, 71, 101, 131},
     {15, 19, 29, 37, 50, 78, 107},
     {9, 12, 17, 19, 29, 56, 82},
     {8, 9, 12, 13, 19, 39, 61}},
    {{93, 98, 91, 105, 125, 160, 189},
     {50, 51, 47, 63, 84, 114, 142},
     {32, 32, 32, 42, 61, 93, 122},
     {16, 17, 19, 29, 44, 72, 100},
     {11, 11, 13, 17, 27, 52, 78},
     {9, 8, 11, 12, 17, 37, 59}},
    {{94, 94, 91, 97, 106, 126, 150},
     {49, 49, 49, 56, 65, 88, 113},
     {30, 30, 32, 36, 46, 69, 92},
     {14, 16, 18, 25, 33, 54, 77},
     {9, 9, 11, 14, 22, 42, 64},
     {8, 8, 8, 10, 16, 33, 52}},
};

#endif
