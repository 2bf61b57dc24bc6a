/* What a new view loses against the best settings measured, in 1/16 dB of PSNR, by head, passes of refinement and
 * percent of the points kept: docs/study/plan.md. tools/study/scripts/plan quality --write makes this file. */
#ifndef T3R_QUALITY_H
#define T3R_QUALITY_H

#include <stdint.h>

#define T3R_QUALITY_HEADS 6
#define T3R_QUALITY_PASSES 6
#define T3R_QUALITY_SHARES 7

static const uint8_t t3r_quality_passes[T3R_QUALITY_PASSES] = {0, 1, 2, 4, 8, 16};
static const uint8_t t3r_quality_percent[T3R_QUALITY_SHARES] = {100, 50, 20, 10, 5, 2, 1};

/* analytic, moment, tiny, nano, small, base */
static const uint8_t t3r_quality_loss_q4[T3R_QUALITY_HEADS][T3R_QUALITY_PASSES][T3R_QUALITY_SHARES] = {
    {{90, 92, 101, 113, 131, 167, 195},
     {52, 56, 62, 72, 91, 122, 153},
     {35, 39, 50, 56, 71, 102, 131},
     {15, 19, 29, 37, 50, 78, 107},
     {9, 12, 17, 19, 29, 56, 82},
     {8, 9, 12, 13, 19, 39, 61}},
    {{92, 91, 94, 104, 118, 143, 164},
     {52, 55, 57, 68, 81, 106, 127},
     {35, 39, 48, 57, 69, 92, 112},
     {15, 18, 26, 34, 46, 69, 91},
     {9, 11, 16, 19, 28, 53, 73},
     {8, 9, 14, 14, 20, 38, 58}},
    {{93, 98, 91, 105, 125, 160, 189},
     {50, 51, 47, 63, 84, 114, 142},
     {32, 32, 32, 42, 61, 93, 122},
     {16, 17, 19, 29, 44, 72, 100},
     {11, 11, 13, 17, 27, 52, 78},
     {9, 8, 11, 12, 18, 37, 59}},
    {{97, 101, 100, 112, 132, 166, 194},
     {52, 53, 54, 68, 90, 118, 144},
     {34, 35, 36, 44, 61, 93, 119},
     {17, 18, 20, 30, 44, 72, 96},
     {11, 11, 12, 16, 26, 50, 74},
     {8, 8, 10, 11, 18, 35, 56}},
    {{94, 94, 91, 97, 106, 126, 151},
     {49, 49, 49, 56, 65, 88, 113},
     {30, 30, 32, 36, 46, 69, 92},
     {15, 16, 18, 25, 33, 54, 77},
     {9, 9, 11, 14, 22, 42, 64},
     {8, 8, 8, 10, 16, 33, 52}},
    {{89, 95, 92, 100, 107, 126, 150},
     {48, 49, 51, 57, 66, 88, 112},
     {29, 30, 32, 37, 48, 70, 92},
     {14, 16, 19, 26, 34, 55, 77},
     {9, 10, 12, 15, 23, 42, 64},
     {7, 8, 10, 11, 15, 32, 53}},
};

#endif
