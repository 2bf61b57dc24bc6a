/* SPDX-License-Identifier: Apache-2.0 */
/* Stub for builds without learned heads: no build is allowed to ask for one (api/checks.c). */
#include "head.h"

#if !T3R_FEATURE_LEARNED

uint32_t t3r_head_learned(const t3r_head_input *input, uint32_t begin, uint32_t end, t3r_gaussian *out)
{
    (void)input;
    (void)begin;
    (void)end;
    (void)out;
    return 0;
}

#endif
