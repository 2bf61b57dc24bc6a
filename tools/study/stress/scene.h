/* SPDX-License-Identifier: Apache-2.0 */
/* Generated scenes that are hard to prune: two context views 0.3 m apart and the target between them, through a 60
 * degree lens, with exact depth in millimetres and exact poses. Lengths are in metres; all randomness comes from
 * stress/random.h. */
#ifndef TRIM3R_TOOLS_STRESS_SCENE_H
#define TRIM3R_TOOLS_STRESS_SCENE_H

#include <stdbool.h>
#include <stdint.h>

#include "study/stress/capture.h"
#include "study/stress/perturbation.h"

#define STRESS_SCENE_SIDE 256u /* unless --working says otherwise */

/* The hit of a ray from (x, y, 0) in direction (dx, dy, 1). */
typedef struct stress_hit {
    double depth;  /* along z, as a depth sensor measures it */
    double rgb[3]; /* 0..255 */
} stress_hit;

/* Traces a ray. `pixel`: the size of a pixel one metre away, in metres; `strength`: the scene's own. */
typedef stress_hit stress_trace(double x, double y, double dx, double dy, double pixel, double strength);

typedef struct stress_scene {
    const char *name, *unit;
    double strength[STRESS_GRADES]; /* rising in difficulty */
    const char *about;              /* text for --help */
    stress_trace *trace;
} stress_scene;

/* Returns scene number `index`, in a stable order; NULL past the last. */
const stress_scene *stress_scene_at(uint32_t index);
/* Draws the scene. False if out of memory; call stress_capture_free() in any case. */
bool stress_scene_draw(stress_capture *capture, const stress_scene *scene, double strength, uint32_t width,
                       uint32_t height);

/* scene_surface.c: the scenes' surfaces. */
stress_trace stress_plane, stress_wall, stress_bars, stress_foliage, stress_mirror;

#endif
