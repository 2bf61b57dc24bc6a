/* What stands for the head of moments where it is left out: no build is allowed to ask for it (api/checks.c). */
#include "head.h"

#if !T3R_FEATURE_MOMENT

uint32_t t3r_head_moment(const t3r_head_input *input, uint32_t begin, uint32_t end, t3r_gaussian *out)
{
    (void)input;
    (void)begin;
    (void)end;
    (void)out;
    return 0;
}

#endif
