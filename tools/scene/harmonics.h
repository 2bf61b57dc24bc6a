/* SPDX-License-Identifier: Apache-2.0 */
/* Spherical harmonics of degree 1 to 3 in double: colours that depend on the viewing direction. The order and the signs
 * are those of 3D Gaussian Splatting and of KHR_gaussian_splatting. */
#ifndef TRIM3R_TOOLS_HARMONICS_H
#define TRIM3R_TOOLS_HARMONICS_H

#include <stdint.h>

#define HARMONICS_DEGREE_MOST 3u
#define HARMONICS_REST_MOST 15u            /* coefficients above degree 0, for each of red, green and blue */
#define HARMONICS_ZERO 0.28209479177387814 /* the harmonic of degree 0: colour = 0.5 + HARMONICS_ZERO x coefficient */

/* Returns the number of coefficients above degree 0: 0, 3, 8, 15. */
static inline uint32_t harmonics_rest(uint32_t degree)
{
    return (degree + 1) * (degree + 1) - 1;
}

/* Evaluates the harmonics above degree 0 at a unit vector, from the camera to the Gaussian. */
void harmonics_of(const double direction[3], double values[HARMONICS_REST_MOST]);

/* The effect of a scene's rotation on coefficients: a matrix for each degree, row-major. */
typedef struct harmonics_turn {
    double degree_1[9], degree_2[25], degree_3[49];
} harmonics_turn;

/* Returns the matrices for a rotation, row-major. */
harmonics_turn harmonics_turn_of(const double rotation[9]);
/* Turns the coefficients of degrees 1 to `degree`, 0..3. */
void harmonics_turn_apply(const harmonics_turn *turn, uint32_t degree, double rest[HARMONICS_REST_MOST][3]);

#endif
