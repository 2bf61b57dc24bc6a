/* Work memory of the comparison of views. */
#ifndef T3R_POINTMAP_WORK_H
#define T3R_POINTMAP_WORK_H

#include "state/state.h"

typedef struct t3r_pointmap_work {
    t3r_workers workers;
    uint32_t *pixels;                   /* one for each pixel of a view */
    uint32_t (*ratios)[T3R_RATIO_BINS]; /* three histograms of exposure */
    const t3r_kernels *kernels;
} t3r_pointmap_work;

static inline t3r_pointmap_work t3r_pointmap_work_of(const t3r_runtime *rt)
{
    uint32_t *pixels = t3r_buffer_at(rt, T3R_BUFFER_POINTMAP_WORK);
    return (t3r_pointmap_work){
        .workers = t3r_workers_of(rt),
        .pixels = pixels,
        .ratios = (uint32_t(*)[T3R_RATIO_BINS])(pixels + (size_t)rt->config.width * rt->config.height),
        .kernels = &rt->kernels,
    };
}

#endif
