/* SPDX-License-Identifier: Apache-2.0 */
#include "reuse.h"

#include "core/features.h"
#include "core/memory.h"
#include "state.h"

bool t3r_is_reused(const t3r_runtime *rt, uint32_t v)
{
    return t3r_is_warm(&rt->config) && (rt->reuse.views >> v & 1) != 0;
}

void t3r_reuse_no_view(t3r_runtime *rt, uint32_t v)
{
    rt->reuse.views &= ~(1u << v);
}

void t3r_reuse_nothing(t3r_runtime *rt)
{
    rt->reuse = (t3r_reuse){0};
}

void t3r_reuse_all(t3r_runtime *rt)
{
    if (!t3r_is_warm(&rt->config)) {
        return;
    }
    memcpy(t3r_buffer_at(rt, T3R_BUFFER_KEPT_CLUSTERS), t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS),
           rt->config.clusters * (size_t)T3R_CLUSTER_BYTES);
    rt->reuse = (t3r_reuse){(1u << rt->views) - 1, 1};
}

uint16_t *t3r_kept_texture(const t3r_runtime *rt, uint32_t v)
{
    return (uint16_t *)t3r_buffer_at(rt, T3R_BUFFER_KEPT_TEXTURE) +
           T3R_PIXELS_(rt->config.width, rt->config.height) * v;
}
