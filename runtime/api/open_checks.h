/* SPDX-License-Identifier: Apache-2.0 */
/* The checks of an arena and of what is bound to a runtime. */
#ifndef T3R_OPEN_CHECKS_H
#define T3R_OPEN_CHECKS_H

#include "kernels/kernels.h"
#include "layout/plan_checks.h"
#include "state/state.h"

#define T3R_NO_ARENA_TEXT "arena is NULL"
#define T3R_ALIGNMENT_TEXT "arena is # bytes after a multiple of #: give it _Alignas(T3R_ARENA_ALIGN)"

/* *layout becomes the arena's. */
T3R_CHECKS t3r_init_checks(const void *arena, size_t arena_bytes, const t3r_config *config, t3r_layout *layout,
                           t3r_fault *fault)
{
    T3R_MISUSE(fault, arena != NULL, T3R_ERR_ARGUMENT, T3R_NO_ARENA_TEXT);
    T3R_MISUSE(fault, config != NULL, T3R_ERR_ARGUMENT, "config is NULL");
    T3R_CHECK_CONFIG(config, fault);
    T3R_CHECK(fault, (uintptr_t)arena % T3R_ARENA_ALIGN == 0, T3R_ERR_ARENA, T3R_ALIGNMENT_TEXT,
              (uintptr_t)arena % T3R_ARENA_ALIGN, T3R_ARENA_ALIGN);
    T3R_CHECK(fault, t3r_lay_out(config, arena_bytes, layout) == T3R_OK, T3R_ERR_ARENA,
              "arena_bytes is @: this configuration needs at least #, and # for full speed (t3r_plan())", arena_bytes,
              layout->min_bytes, layout->bytes);
    return T3R_OK;
}

/* Checks all but the contents of an arena. *layout becomes that of its configuration. */
T3R_CHECKS t3r_attach_checks(const void *arena, size_t arena_bytes, t3r_layout *layout, t3r_fault *fault)
{
    T3R_MISUSE(fault, arena != NULL, T3R_ERR_ARGUMENT, T3R_NO_ARENA_TEXT);
    T3R_CHECK(fault, (uintptr_t)arena % T3R_ARENA_ALIGN == 0, T3R_ERR_ARENA, T3R_ALIGNMENT_TEXT,
              (uintptr_t)arena % T3R_ARENA_ALIGN, T3R_ARENA_ALIGN);
    T3R_CHECK(fault, arena_bytes >= T3R_HEADER_BYTES, T3R_ERR_ARENA,
              "arena_bytes is #: the head of an arena alone has #", arena_bytes, T3R_HEADER_BYTES);
    const t3r_runtime *state = arena;
    T3R_CHECK(fault, state->magic == T3R_MAGIC, T3R_ERR_EPOCH,
              "arena holds no runtime: t3r_init() makes one, and a copy begins with its first byte");
    T3R_CHECK(fault, state->bits_epoch == T3R_BITS_EPOCH, T3R_ERR_EPOCH,
              "arena is of bits epoch #, and this library of #: build the scene again", state->bits_epoch,
              T3R_BITS_EPOCH);
    T3R_CHECK(fault, state->arena_bytes == arena_bytes, T3R_ERR_EPOCH,
              "arena_bytes is @: the arena that was copied has @", arena_bytes, state->arena_bytes);
    T3R_CHECK(fault, t3r_config_check(&state->config) == T3R_OK, T3R_ERR_EPOCH,
              "arena is damaged, or needs a feature that this library was built without");
    T3R_CHECK(fault, t3r_lay_out(&state->config, arena_bytes, layout) == T3R_OK, T3R_ERR_EPOCH,
              "arena is damaged: its configuration needs more bytes than it has");
    return T3R_OK;
}

T3R_CHECKS t3r_set_cpu_checks(const t3r_runtime *rt, uint32_t features, t3r_fault *fault)
{
    T3R_PASS(t3r_runtime_checks(rt, fault));
    T3R_MISUSE(fault, (features & ~t3r_kernels_features()) == 0, T3R_ERR_ARGUMENT,
               "features has #, which this build on this processor has not: t3r_cpu_found()",
               features & ~t3r_kernels_features());
    return T3R_OK;
}

#endif
