/* SPDX-License-Identifier: Apache-2.0 */
/* Stubs for builds without stereo: core/config.c refuses configurations that ask for it. */
#include "stereo_views.h"

#if !T3R_FEATURE_STEREO

void t3r_stereo_clear(const t3r_view *views, uint32_t count)
{
    (void)views;
    (void)count;
}

bool t3r_stereo_take(t3r_runtime *rt, t3r_view *views)
{
    (void)rt;
    (void)views;
    return false;
}

t3r_status t3r_stereo_views(t3r_runtime *rt, t3r_view *views)
{
    (void)rt;
    (void)views;
    return T3R_ERR_UNSUPPORTED;
}

#endif
