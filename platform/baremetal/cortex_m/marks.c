#include "marks.h"

/* Each function has a statement that the compiler cannot merge, so that no two share an address. */
#define MARK(name)                                                                                                     \
    void mark_##name(void);                                                                                            \
    __attribute__((noinline)) void mark_##name(void)                                                                   \
    {                                                                                                                  \
        __asm__ volatile("@ " #name ::: "memory");                                                                     \
    }

MARK(other)
MARK(image)
MARK(depth)
MARK(pointmap)
MARK(wavelet)
MARK(superclusters)
MARK(budget)
MARK(head)
MARK(refine)
MARK(raster)

void mark_stage(t3r_stage stage)
{
    static void (*const marks[T3R_STAGE_COUNT])(void) = {
        [T3R_STAGE_IMAGE] = mark_image,
        [T3R_STAGE_DEPTH] = mark_depth,
        [T3R_STAGE_POINTMAP] = mark_pointmap,
        [T3R_STAGE_WAVELET] = mark_wavelet,
        [T3R_STAGE_SUPERCLUSTERS] = mark_superclusters,
        [T3R_STAGE_BUDGET] = mark_budget,
        [T3R_STAGE_HEAD] = mark_head,
        [T3R_STAGE_REFINE] = mark_refine,
        [T3R_STAGE_RASTER] = mark_raster,
    };
    marks[stage]();
}
