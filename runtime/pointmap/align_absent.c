/* Alignment where it is left out: no configuration asks for it (core/config.c). */
#include "align.h"

#if !T3R_FEATURE_ALIGN

t3r_status t3r_align_views(t3r_runtime *rt, t3r_view *views, uint32_t steps)
{
    (void)rt, (void)views, (void)steps;
    return T3R_OK;
}

#endif
