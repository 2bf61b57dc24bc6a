/* SPDX-License-Identifier: Apache-2.0 */
/* Lays out the arena, or attaches to a copied one. */
#include "api/open_checks.h"
#include "api/restored.h"
#include "core/hash.h"
#include "core/memory.h"
#include "image/image.h"
#include "state/state.h"

/* Returns a hash of the layout: an arena laid out by another build is refused. */
static uint64_t layout_hash(const t3r_layout *layout)
{
    uint64_t hash = t3r_hash_u32(T3R_HASH_START, T3R_BUFFER_COUNT);
    for (int b = 0; b < T3R_BUFFER_COUNT; b++) {
        hash = t3r_hash_u64(t3r_hash_u64(hash, layout->offset[b]), layout->size[b]);
    }
    return t3r_hash_u32(hash, (uint32_t)sizeof(struct t3r_runtime));
}

static void bind_layout(t3r_runtime *rt, const t3r_layout *layout)
{
    for (int b = 0; b < T3R_BUFFER_COUNT; b++) {
        rt->offset[b] = layout->offset[b];
    }
    rt->list_capacity = layout->list_capacity;
    rt->refine_bytes = layout->refine_bytes;
    rt->layout_hash = layout_hash(layout);
}

t3r_status t3r_init_as(uint64_t digest, t3r_runtime **rt, void *arena, size_t arena_bytes, const t3r_config *config)
{
    T3R_REFUSE_UNLESS(rt != NULL, T3R_ERR_ARGUMENT);
    *rt = NULL;
    T3R_REFUSE_UNLESS(digest == t3r_header_interface(), T3R_ERR_INTERFACE);
    t3r_layout layout;
    T3R_PASS(t3r_init_checks(arena, arena_bytes, config, &layout, NULL));
    t3r_runtime *state = arena;
    memset(state, 0, sizeof *state);
    state->magic = T3R_MAGIC;
    state->bits_epoch = T3R_BITS_EPOCH;
    state->arena_bytes = arena_bytes;
    state->config = t3r_settled(config);
    state->build = t3r_build_of(config);
    state->kernels = t3r_kernels_c;
    bind_layout(state, &layout);
    *rt = state;
    return T3R_OK;
}

t3r_status t3r_reset(t3r_runtime *rt)
{
    T3R_REFUSE_UNLESS(rt != NULL, T3R_ERR_ARGUMENT);
    rt->views = 0;
    rt->analysed = 0;
    rt->has_scene = 0;
    rt->gaussians = 0;
    rt->valid_points = 0;
    rt->keyframes = 0;
    if (T3R_FEATURE_STREAMS) {
        rt->remembered = 0;
        rt->gate = (t3r_gate){0};
    }
    rt->next_slot = 0;
    rt->strips = (t3r_strips){0};
    t3r_reuse_nothing(rt);
    return T3R_OK;
}

const t3r_config *t3r_get_config(const t3r_runtime *rt)
{
    return rt != NULL ? &rt->config : NULL;
}

t3r_status t3r_set_hooks(t3r_runtime *rt, const t3r_hooks *hooks)
{
    T3R_REFUSE_UNLESS(rt != NULL, T3R_ERR_ARGUMENT);
    rt->hooks = hooks != NULL ? *hooks : (t3r_hooks){0};
    return T3R_OK;
}

t3r_status t3r_set_cpu(t3r_runtime *rt, uint32_t features)
{
    T3R_PASS(t3r_set_cpu_checks(rt, features, NULL));
    t3r_kernels_choose(&rt->kernels, features);
    return T3R_OK;
}

uint32_t t3r_cpu_found(void)
{
#ifdef __ARM_FEATURE_DOTPROD
    return t3r_kernels_features();
#else
    return t3r_kernels_features() & ~T3R_CPU_DOTPROD; /* of which only the operating system knows */
#endif
}

uint32_t t3r_get_cpu(const t3r_runtime *rt)
{
    return rt != NULL ? rt->kernels.features : 0;
}

t3r_status t3r_attach_as(uint64_t digest, t3r_runtime **rt, void *arena, size_t arena_bytes)
{
    T3R_REFUSE_UNLESS(rt != NULL, T3R_ERR_ARGUMENT);
    *rt = NULL;
    T3R_REFUSE_UNLESS(digest == t3r_header_interface(), T3R_ERR_INTERFACE);
    t3r_layout layout;
    T3R_PASS(t3r_attach_checks(arena, arena_bytes, &layout, NULL));
    t3r_runtime *state = arena;
    if (state->layout_hash != layout_hash(&layout)) {
        return T3R_ERR_EPOCH;
    }
    bind_layout(state, &layout);
    if (!t3r_is_restored(state)) {
        return T3R_ERR_EPOCH;
    }
    memset(&state->hooks, 0, sizeof state->hooks);
    state->weights = NULL;
    state->depth_of = NULL;
    state->strips = (t3r_strips){0}; /* its sums may be damaged */
    state->kernels = t3r_kernels_c;
    *rt = state;
    return T3R_OK;
}
