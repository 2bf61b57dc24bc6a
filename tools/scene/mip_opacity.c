/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/mip_opacity.h"

#include <math.h>

#include "scene/gaussian_shape.h"

#define WIDENED 0.3 /* square pixels; runtime/SPEC.md, "Raster" */
#define HELD 1.3    /* half fields of view: bound of the Jacobian, as there */

static double held(double slope, double pixels, double focal)
{
    const double most = HELD * pixels / (2 * focal);
    return fmin(fmax(slope, -most), most);
}

/* Returns a^T covariance b. */
static double between(const double covariance[9], const double a[3], const double b[3])
{
    double sum = 0;
    for (int i = 0; i < 9; i++) {
        sum += a[i / 3] * covariance[i] * b[i % 3];
    }
    return sum;
}

uint16_t mip_opacity_q15(const t3r_gaussian *gaussian, const splat_camera *camera)
{
    double seen[3], row[2][3], covariance[9];
    const double *r = camera->rotation;
    for (int i = 0; i < 3; i++) { /* scene to camera */
        seen[i] = 0;
        for (int k = 0; k < 3; k++) {
            seen[i] += r[3 * k + i] * (ldexp(gaussian->position_q20[k], -20) - camera->position[k]);
        }
    }
    if (!(seen[2] > 0)) {
        return gaussian->opacity_q15; /* it is not drawn */
    }
    const double u = held(seen[0] / seen[2], camera->width, camera->fx),
                 v = held(seen[1] / seen[2], camera->height, camera->fy);
    for (int k = 0; k < 3; k++) { /* pixels a scene unit along each axis of the scene */
        row[0][k] = camera->fx / seen[2] * (r[3 * k] - u * r[3 * k + 2]);
        row[1][k] = camera->fy / seen[2] * (r[3 * k + 1] - v * r[3 * k + 2]);
    }
    gaussian_covariance(gaussian, covariance);
    const double a = between(covariance, row[0], row[0]), b = between(covariance, row[0], row[1]),
                 c = between(covariance, row[1], row[1]);
    const double ratio = (a * c - b * b) / ((a + WIDENED) * (c + WIDENED) - b * b);
    return (uint16_t)nearbyint(gaussian->opacity_q15 * sqrt(fmin(fmax(ratio, 0), 1)));
}
