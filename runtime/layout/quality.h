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
    {{99, 103, 127, 139, 153, 178, 202},
     {44, 45, 59, 71, 90, 122, 150},
     {32, 33, 49, 56, 71, 100, 128},
     {23, 19, 33, 37, 50, 76, 106},
     {22, 14, 22, 20, 29, 55, 80},
     {23, 13, 19, 14, 21, 40, 62}},
    {{108, 112, 123, 134, 144, 161, 174},
     {45, 50, 54, 66, 79, 104, 124},
     {29, 35, 46, 55, 67, 89, 109},
     {13, 17, 27, 34, 45, 68, 88},
     {10, 12, 19, 20, 29, 52, 71},
     {10, 12, 17, 16, 21, 38, 56}},
    {{97, 101, 100, 112, 131, 163, 189},
     {40, 42, 50, 67, 89, 115, 142},
     {28, 30, 34, 44, 61, 91, 117},
     {17, 18, 22, 30, 43, 70, 96},
     {14, 14, 16, 17, 26, 50, 73},
     {13, 12, 15, 13, 20, 35, 53}},
    {{97, 101, 100, 112, 131, 163, 189},
     {40, 42, 50, 67, 89, 115, 142},
     {28, 30, 34, 44, 61, 91, 117},
     {17, 18, 22, 30, 43, 70, 96},
     {14, 14, 16, 17, 26, 50, 73},
     {13, 12, 15, 13, 20, 35, 53}},
    {{93, 94, 91, 97, 105, 126, 149},
     {37, 38, 45, 55, 65, 89, 111},
     {27, 27, 31, 36, 45, 68, 91},
     {17, 17, 20, 24, 33, 54, 75},
     {16, 14, 15, 15, 22, 42, 64},
     {16, 13, 14, 11, 17, 33, 51}},
    {{88, 94, 92, 99, 106, 123, 148},
     {34, 38, 47, 55, 66, 89, 111},
     {25, 26, 32, 37, 47, 68, 91},
     {16, 16, 21, 25, 33, 53, 75},
     {15, 14, 16, 16, 23, 42, 63},
     {15, 13, 14, 13, 19, 33, 51}},
};

#endif
