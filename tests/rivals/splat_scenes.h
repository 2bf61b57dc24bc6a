/* SPDX-License-Identifier: Apache-2.0 */
/* Small scenes for the tests of the rivals. */
#ifndef TRIM3R_TESTS_RIVALS_SPLAT_SCENES_H
#define TRIM3R_TESTS_RIVALS_SPLAT_SCENES_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "oracle/float64/drawing.h"
#include "study/rivals/splats/splat_view.h"

static inline void assert_near(double a, double b, double bound)
{
    if (!(fabs(a - b) <= bound)) {
        fail_msg("%.9g is not within %g of %.9g", a, bound, b);
    }
}

/* The frame of the scenes: scene units are world units, their origin the world's. */
extern const t3r_scene_frame scene_frame;

/* Makes `count` parameter rows: opacity 1/2, grey, tiny, one unit ahead. Call splat_model_free(). */
splat_model plain_model(uint32_t count);
double *parameters_of(const splat_model *model, uint32_t gaussian);
/* Makes Gaussian a ball of `sigma` at x, y, z. */
void set_ball(const splat_model *model, uint32_t gaussian, double x, double y, double z, double sigma, double opacity);

/* Makes Gaussians of all shapes before a camera at the origin with this focal length, in order of depth and clearly
 * apart. */
splat_model random_model(dice *d, uint32_t count, double focal, uint32_t width, uint32_t height);

/* Returns a camera at the origin, looking along +z, with the principal point in the middle. */
splat_camera middle_camera(double focal, uint32_t width, uint32_t height);

/* Opens a view and projects the model. Call splat_view_close(). */
splat_view view_of(const splat_model *model, const splat_camera *camera, double alpha_least);

#endif
