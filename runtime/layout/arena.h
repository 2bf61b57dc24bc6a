/* SPDX-License-Identifier: Apache-2.0 */
/* The arena planner: one layout function behind t3r_plan(), t3r_init() and the macros of trim3r_arena.h. */
#ifndef T3R_ARENA_H
#define T3R_ARENA_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

typedef struct t3r_layout {
    size_t min_bytes, bytes;
    size_t offset[T3R_BUFFER_COUNT];
    size_t size[T3R_BUFFER_COUNT];
    size_t list_capacity; /* entries of the tile lists */
    size_t refine_bytes;  /* of the refinement work */
} t3r_layout;

/* Lays an arena of arena_bytes out (T3R_ERR_ARENA when that is too few; layout->min_bytes and bytes are set all
 * the same). The configuration must have passed t3r_config_error(). */
t3r_status t3r_lay_out(const t3r_config *config, size_t arena_bytes, t3r_layout *layout);

const char *t3r_buffer_name(enum t3r_buffer buffer);
void t3r_buffer_lifetime(const t3r_config *config, enum t3r_buffer buffer, t3r_stage *first, t3r_stage *last);

#endif
