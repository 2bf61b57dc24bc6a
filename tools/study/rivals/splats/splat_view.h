/* SPDX-License-Identifier: Apache-2.0 */
/* A differentiable rasterizer of 3-D Gaussians in floats, for the host; the rivals score and fine-tune with it.
 *
 * It draws the same pictures as the runtime's raster, from the same definitions (EWA projection, 0.3 px^2 low-pass,
 * alpha = min(0.99, opacity exp(-q)), nothing below 1/255, pixels closed below a transmittance of 1e-4, order by camera
 * z in Q20, then index; black background), and differentiates them. A view is opened once, projected for every state of
 * a model, and then drawn, walked or differentiated in tiles. */
#ifndef TRIM3R_TOOLS_RIVALS_SPLAT_VIEW_H
#define TRIM3R_TOOLS_RIVALS_SPLAT_VIEW_H

#include <stdbool.h>
#include <stdint.h>

#include "scene/splat_camera.h"
#include "study/rivals/splats/splat_model.h"
#include "trim3r.h"

#define SPLAT_ALPHA_LEAST (1.0 / 255)
#define SPLAT_ALPHA_MOST 0.99f
#define SPLAT_CLOSED 1e-4f /* transmittance below which a pixel is finished */
#define SPLAT_LOW_PASS 0.3 /* px^2 */

/* Side of a tile: a row fits into vector registers. */
enum { SPLAT_TILE = 8 };

/* A projected Gaussian: q = (a dx^2 + 2 b dx dy + c dy^2) / 2 at dx, dy pixels from its centre. */
typedef struct splat {
    float x, y;
    float a, b, c;
    float opacity;
    float colour[3];
    int32_t left, top, right, bottom; /* the pixels that the splat may reach, inclusive; right < left: none */
    uint32_t depth_key;               /* camera z, Q20 */
} splat;

/* Derivatives of some measure with respect to a splat's numbers. */
typedef struct splat_gradient {
    double x, y, a, b, c, opacity, colour[3];
} splat_gradient;

typedef struct splat_view {
    splat_camera camera;
    double alpha_least; /* SPLAT_ALPHA_LEAST; tests lower it, because the cut has no derivative */
    uint32_t count;     /* Gaussians of the model */
    splat *splats;
    uint32_t across, down; /* tiles */
    uint32_t *first;       /* tiles + 1 places in `list` */
    uint32_t *list;        /* the splats of each tile, front to back */
    size_t list_room;
    uint32_t *order; /* twice count: work of the sort */
} splat_view;

/* Return false if out of memory; call splat_view_close() in any case. */
bool splat_view_open(splat_view *view, const splat_camera *camera, uint32_t count);
bool splat_view_project(splat_view *view, const splat_model *model);
void splat_view_close(splat_view *view);

/* Draws the view. rgb: width x height x 3, 0..1; transmittance: width x height, may be NULL. */
void splat_view_draw(const splat_view *view, float *rgb, float *transmittance);

/* A row of a tile that one splat touches: alpha, 0 where the splat has no effect, and the transmittance before the
 * splat. */
typedef struct splat_row {
    uint32_t gaussian;
    uint32_t x, y, columns; /* pixels x .. x + columns - 1 of row y */
    float alpha[SPLAT_TILE], before[SPLAT_TILE];
} splat_row;

/* Calls visit() for every row of every splat, front to back for each pixel. */
void splat_view_walk(const splat_view *view, void (*visit)(void *user, const splat_row *row), void *user);

/* Adds the derivatives of a measure with respect to every splat's numbers to gradients[count], given the drawn picture
 * and the measure's derivatives with respect to its values. */
void splat_view_differentiate(const splat_view *view, const float *rgb, const float *rgb_gradient,
                              splat_gradient *gradients);

/* Applies the chain rule through the projection and the parametrisation; adds to gradient[SPLAT_PARAMETERS]. */
void splat_chain(const splat_camera *camera, const double *parameters, const splat_gradient *g, double *gradient);

/* ---- internal --------------------------------------------------------------------------------------------- */

/* Projects one Gaussian; right < left if it is culled. */
splat splat_project(const splat_camera *camera, const double *parameters, double alpha_least);
/* Sets the first and the last pixel within `reach` of `centre`, cut to a picture of that side. */
void splat_cut(double centre, double reach, uint32_t side, int32_t *low, int32_t *high);
/* Fills `first` and `list` from the projected splats. */
bool splat_view_bin(splat_view *view);

#endif
