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
    {{88, 91, 101, 113, 130, 167, 195},
     {51, 55, 61, 72, 90, 122, 152},
     {34, 39, 49, 56, 71, 102, 131},
     {14, 19, 29, 37, 50, 78, 107},
     {9, 12, 16, 19, 29, 55, 83},
     {7, 8, 12, 12, 20, 39, 62}},
    {{92, 97, 91, 105, 125, 160, 188},
     {50, 51, 47, 63, 84, 114, 142},
     {31, 32, 32, 42, 60, 93, 122},
     {16, 17, 19, 29, 45, 72, 100},
     {10, 11, 13, 16, 27, 52, 76},
     {9, 8, 11, 11, 17, 37, 58}},
    {{94, 94, 90, 97, 105, 126, 149},
     {49, 49, 49, 56, 65, 88, 112},
     {30, 30, 32, 36, 46, 69, 92},
     {14, 16, 18, 25, 33, 54, 76},
     {9, 9, 12, 14, 22, 42, 63},
     {8, 7, 9, 10, 16, 33, 52}},
};

#endif
