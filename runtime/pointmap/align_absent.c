/* Stub for builds without alignment: core/config.c refuses configurations that ask for it. */
#include "align.h"

#if !T3R_FEATURE_ALIGN

t3r_status t3r_align_views(t3r_runtime *rt, t3r_view *views, uint32_t steps)
{
    (void)rt, (void)views, (void)steps;
    return T3R_OK;
}

#endif
