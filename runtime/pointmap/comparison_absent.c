/* SPDX-License-Identifier: Apache-2.0 */
/* Stubs for builds without comparison of views: core/config.c refuses a second view and streams. */
#include "align.h"
#include "bridge.h"
#include "contradiction.h"
#include "depth/surroundings.h"
#include "exposure.h"
#include "redundancy.h"

#if !T3R_FEATURE_COMPARISON

t3r_status t3r_align_views(t3r_runtime *rt, t3r_view *views, uint32_t steps)
{
    (void)rt, (void)views, (void)steps;
    return T3R_OK;
}

t3r_status t3r_align_view(t3r_runtime *rt, t3r_view *views, uint32_t v)
{
    (void)rt, (void)views, (void)v;
    return T3R_OK;
}

void t3r_bridge_lend(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent, const t3r_pointmap_work *work)
{
    (void)views, (void)count, (void)v, (void)exponent, (void)work;
}

uint32_t t3r_bridge_settle(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent, uint32_t settled,
                           const t3r_pointmap_work *work)
{
    (void)views, (void)count, (void)v, (void)exponent, (void)settled, (void)work;
    return 0; /* the result is unused */
}

const uint16_t *t3r_fill_surroundings(const t3r_view *view, t3r_depth_source source, void *work)
{
    (void)view, (void)source;
    return work; /* the result is unused */
}

void t3r_find_contradicted(const t3r_contradictions *job, t3r_points *points, const t3r_unprojection *from)
{
    (void)job, (void)from;
    points->count = 0;
}

bool t3r_seen_through(const t3r_pointmap *to, const t3r_projected_pixel *projected, bool filled)
{
    (void)to, (void)projected, (void)filled;
    return false;
}

uint32_t t3r_exposure_gains(const t3r_view *views, uint32_t count, int32_t exponent, uint16_t gain_q14[][3],
                            const t3r_pointmap_work *work)
{
    (void)views, (void)exponent, (void)gain_q14, (void)work; /* the caller has set all gains to 1 */
    return count;
}

uint32_t t3r_mark_covered(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent,
                          const t3r_pointmap_work *work)
{
    (void)views, (void)count, (void)v, (void)exponent, (void)work;
    return 0;
}

void t3r_clear_witnesses(const t3r_view *views, uint32_t count)
{
    (void)views, (void)count;
}

#endif
