/* SPDX-License-Identifier: Apache-2.0 */
/* Stubs for builds without refinement: core/config.c refuses configurations that ask for a pass. */
#include "refine.h"

#if !T3R_FEATURE_REFINEMENT

t3r_status t3r_refine(t3r_runtime *rt, const t3r_view *views, t3r_passes passes)
{
    return t3r_refine_scene(rt, views, passes, 0, NULL);
}

t3r_status t3r_refine_scene(t3r_runtime *rt, const t3r_view *views, t3r_passes passes, uint32_t round,
                            const t3r_map_record *records)
{
    (void)rt;
    (void)round;
    (void)views;
    (void)records;
    return passes.count == 0 ? T3R_OK : T3R_ERR_UNSUPPORTED;
}

#endif
