/* SPDX-License-Identifier: Apache-2.0 */
/* Cuts memory into consecutive parts. Each part takes T3R_UP_(bytes), and the plan's formula sums the same parts, so a
 * cut ends exactly where the plan says. */
#ifndef T3R_CUT_H
#define T3R_CUT_H

#include <stddef.h>
#include <stdint.h>

#include "assertion.h"
#include "trim3r_arena.h"

typedef struct t3r_cut {
    uint8_t *at, *end;
} t3r_cut;

static inline t3r_cut t3r_cut_of(void *memory, size_t bytes)
{
    uint8_t *at = memory;
    return (t3r_cut){at, at + bytes};
}

static inline size_t t3r_cut_left(const t3r_cut *cut)
{
    return (size_t)(cut->end - cut->at);
}

/* Returns the next part. It has the alignment of the memory, up to T3R_ARENA_ALIGN. */
static inline void *t3r_take(t3r_cut *cut, size_t bytes)
{
    uint8_t *part = cut->at;
    T3R_ASSERT(T3R_UP_(bytes) <= t3r_cut_left(cut));
    cut->at += T3R_UP_(bytes);
    return part;
}

#endif
