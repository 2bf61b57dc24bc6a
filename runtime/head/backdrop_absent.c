/* SPDX-License-Identifier: Apache-2.0 */
/* Stub for builds without a backdrop: core/config.c refuses configurations that ask for one. */
#include "backdrop.h"

#if !T3R_FEATURE_BACKDROP

uint32_t t3r_backdrop_count(const t3r_runtime *rt, const t3r_view *views)
{
    (void)rt, (void)views;
    return 0;
}

void t3r_add_backdrop(t3r_runtime *rt, const t3r_view *views)
{
    (void)rt, (void)views;
}

#endif
