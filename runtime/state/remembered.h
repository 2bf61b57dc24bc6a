/* SPDX-License-Identifier: Apache-2.0 */
/* Keyframes that a stream remembers after their planes are overwritten: their colours, for refinement. */
#ifndef T3R_REMEMBERED_H
#define T3R_REMEMBERED_H

#include <stdbool.h>
#include <stdint.h>

#include "core/assertion.h"
#include "core/features.h"
#include "core/fixed.h"
#include "state.h"

/* Head of a remembered keyframe. Its pixels follow row by row at T3R_REMEMBERED_HEAD_BYTES. Any values are safe. */
typedef struct t3r_remembered {
    t3r_camera camera; /* at the working size */
    uint16_t gain_q14[3];
    uint16_t unused;
    uint32_t number; /* 1 for the first keyframe */
} t3r_remembered;

_Static_assert(sizeof(t3r_remembered) <= T3R_REMEMBERED_HEAD_BYTES,
               "trim3r_arena.h knows what comes before the pixels");

/* Returns remembered keyframe i of rt->remembered. */
static inline t3r_remembered *t3r_remembered_at(const t3r_runtime *rt, uint32_t i)
{
    uint8_t *all = t3r_buffer_at(rt, T3R_BUFFER_REMEMBERED);
    return (void *)(all + i * T3R_REMEMBERED_BYTES(rt->config.width, rt->config.height));
}

static inline uint16_t *t3r_remembered_pixels(t3r_remembered *keyframe)
{
    return (void *)((uint8_t *)keyframe + T3R_REMEMBERED_HEAD_BYTES);
}

/* Set in a pixel that had a depth. The lower bits are five each of r, g, b, from the lowest on. */
#define T3R_REMEMBERED_KNOWN 0x8000u

static inline bool t3r_is_remembered(uint16_t pixel)
{
    return (pixel & T3R_REMEMBERED_KNOWN) != 0;
}

/* Returns a channel's level, Q7. 32,640 / 31 is 1052.9, so only the largest value needs the bound. */
static inline uint32_t t3r_remembered_q7(uint16_t pixel, int channel)
{
    return T3R_MIN((uint32_t)(pixel >> (5 * channel) & 31) * 1053u, 255u * 128u);
}

/* Remembered keyframes drawn in each pass of refinement, in turn. */
#define T3R_REMEMBERED_A_PASS 2u

static inline uint32_t t3r_remembered_a_pass(const t3r_runtime *rt)
{
    return t3r_is_stream(&rt->config) ? T3R_MIN(rt->remembered, T3R_REMEMBERED_A_PASS) : 0;
}

#endif
