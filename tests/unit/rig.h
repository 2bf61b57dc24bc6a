/* SPDX-License-Identifier: Apache-2.0 */
/* Views of a plane, for tests that compare views. */
#ifndef T3R_TESTS_UNIT_RIG_H
#define T3R_TESTS_UNIT_RIG_H

#include "pointmap/pointmap_work.h"
#include "state/views.h"
#include "unit.h"

enum { W = 64, H = 48, PIXELS = W * H, F = 64, VIEWS = 3 };

/* Depth steps of 1/1024 scene unit; exponent 0, so that a world unit is a scene unit. */
#define UNIT 1024
#define UNIT_Q40 (UINT64_C(1) << 30)

typedef struct rig {
    uint8_t colour[VIEWS][3][PIXELS];
    uint16_t depth[VIEWS][PIXELS];
    uint8_t validity[VIEWS][PIXELS];
    t3r_view view[VIEWS];
} rig;

/* Places a camera that looks along +z from x, 0, z at a parallel plane at depth `plane` from the origin, measured in
 * steps of that many world units. */
static inline void place_view_in_steps(rig *s, int v, double x, double z, double plane, uint64_t unit_q40)
{
    t3r_view *view = &s->view[v];
    *view = (t3r_view){
        .width = W,
        .height = H,
        .colour = {s->colour[v][0], s->colour[v][1], s->colour[v][2]},
        .depth = s->depth[v],
        .validity = s->validity[v],
        .fx_q16 = F << 16,
        .fy_q16 = F << 16,
        .cx_q16 = (W / 2) << 16,
        .cy_q16 = (H / 2) << 16,
        .depth_unit_q40 = unit_q40,
    };
    for (int i = 0; i < 3; i++) {
        view->pose.rotation_q30[4 * i] = 1 << 30;
    }
    view->pose.position_q20[0] = (int32_t)lround(x * (1 << 20));
    view->pose.position_q20[2] = (int32_t)lround(z * (1 << 20));
    for (int i = 0; i < PIXELS; i++) {
        s->depth[v][i] = (uint16_t)lround((plane - z) * (double)(UINT64_C(1) << 40) / (double)unit_q40);
        s->validity[v][i] = T3R_MEASURED;
    }
}

static inline void place_view(rig *s, int v, double x, double z, double plane)
{
    place_view_in_steps(s, v, x, z, plane, UNIT_Q40);
}

/* Views compared by one worker. */
static uint32_t compared[PIXELS], ratios[3][T3R_RATIO_BINS];
static const t3r_pointmap_work alone = {{NULL, 1}, compared, ratios, &t3r_kernels_c};

/* Returns two cameras 8 pixels of disparity apart, in front of a plane at 2. */
static inline rig *pair_new(void)
{
    rig *s = unit_array(1, sizeof *s);
    place_view(s, 0, 0, 0, 2);
    place_view(s, 1, 0.25, 0, 2);
    return s;
}

#endif
