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
    {{99, 103, 126, 137, 151, 175, 202},
     {43, 44, 59, 71, 88, 119, 149},
     {32, 33, 48, 56, 70, 99, 127},
     {23, 19, 32, 37, 49, 75, 104},
     {22, 14, 22, 20, 29, 54, 80},
     {23, 13, 19, 15, 21, 39, 61}},
    {{108, 112, 122, 133, 144, 161, 175},
     {45, 49, 54, 65, 79, 104, 124},
     {29, 34, 45, 55, 67, 90, 109},
     {14, 17, 27, 34, 45, 68, 88},
     {10, 11, 18, 20, 29, 52, 71},
     {10, 11, 17, 16, 21, 39, 57}},
    {{92, 97, 92, 104, 123, 156, 185},
     {38, 40, 43, 61, 82, 111, 139},
     {26, 28, 31, 42, 59, 91, 119},
     {16, 17, 21, 29, 44, 70, 96},
     {13, 13, 16, 18, 28, 52, 75},
     {13, 13, 15, 14, 19, 38, 57}},
    {{97, 100, 100, 111, 130, 161, 189},
     {40, 42, 50, 65, 87, 115, 140},
     {28, 30, 34, 43, 60, 90, 116},
     {16, 18, 22, 30, 43, 70, 93},
     {14, 14, 15, 18, 26, 49, 71},
     {13, 12, 14, 14, 19, 35, 53}},
    {{93, 93, 91, 96, 105, 124, 147},
     {37, 38, 45, 55, 64, 86, 109},
     {27, 26, 31, 36, 45, 67, 89},
     {17, 17, 20, 24, 32, 53, 75},
     {15, 13, 14, 15, 22, 42, 62},
     {16, 13, 13, 12, 17, 34, 52}},
    {{88, 94, 91, 98, 105, 123, 146},
     {34, 38, 47, 55, 65, 87, 109},
     {25, 26, 32, 36, 47, 68, 89},
     {16, 16, 20, 25, 33, 53, 74},
     {14, 13, 16, 16, 24, 41, 62},
     {15, 13, 14, 13, 18, 32, 51}},
};

#endif
