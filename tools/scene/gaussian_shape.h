/* Converts the shape of a Gaussian between the runtime's factor F (covariance F F^T) and axes and rotation, as files
 * hold it. */
#ifndef TRIM3R_TOOLS_GAUSSIAN_SHAPE_H
#define TRIM3R_TOOLS_GAUSSIAN_SHAPE_H

#include "trim3r.h"

/* Standard deviations along the three axes, and the rotation from the axes to the frame. */
typedef struct gaussian_shape {
    double scale[3];    /* > 0 */
    double rotation[4]; /* unit quaternion, w x y z; w >= 0 */
} gaussian_shape;

/* The least scale that is written, relative to the largest of the same Gaussian: a logarithm needs a number above 0,
 * and anything this thin becomes 0 in the factor's 15 bits again. A Gaussian of no extent gets GAUSSIAN_SHAPE_POINT. */
#define GAUSSIAN_SHAPE_THINNEST 0x1p-20
#define GAUSSIAN_SHAPE_POINT 0x1p-60

/* Returns the shape in the units of F: scene units. */
gaussian_shape gaussian_shape_of(const t3r_gaussian *gaussian);

/* Sets factor and factor_exponent to R diag(scale); the scales are in scene units and may be 0 or negative. Returns 0,
 * or -1 when the shape is too large for the format (entries of 2^30 and more) or not finite. */
int gaussian_shape_set(t3r_gaussian *gaussian, const double scale[3], const double rotation[4]);

/* Computes the covariance F F^T, row-major, in scene units squared. */
void gaussian_covariance(const t3r_gaussian *gaussian, double covariance[9]);

#endif
