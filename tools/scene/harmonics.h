/* Spherical harmonics of degree 1 to 3 in double: how colours of a scene change with the direction of view. The order
 * and the signs are those of 3D Gaussian Splatting and of KHR_gaussian_splatting. */
#ifndef TRIM3R_TOOLS_HARMONICS_H
#define TRIM3R_TOOLS_HARMONICS_H

#include <stdint.h>

#define HARMONICS_DEGREE_MOST 3u
#define HARMONICS_REST_MOST 15u            /* coefficients above degree 0, for each of red, green and blue */
#define HARMONICS_ZERO 0.28209479177387814 /* the harmonic of degree 0: colour = 0.5 + HARMONICS_ZERO x coefficient */

/* Coefficients above degree 0 of a degree: 0, 3, 8, 15. */
static inline uint32_t harmonics_rest(uint32_t degree)
{
    return (degree + 1) * (degree + 1) - 1;
}

/* The harmonics above degree 0 of a unit vector, from the camera to the Gaussian. */
void harmonics_of(const double direction[3], double values[HARMONICS_REST_MOST]);

/* How coefficients change when a scene is turned: a matrix for each degree, row-major. */
typedef struct harmonics_turn {
    double degree_1[9], degree_2[25], degree_3[49];
} harmonics_turn;

/* Of a rotation, row-major. */
harmonics_turn harmonics_turn_of(const double rotation[9]);
/* Turns the coefficients of 0..3 degrees. */
void harmonics_turn_apply(const harmonics_turn *turn, uint32_t degree, double rest[HARMONICS_REST_MOST][3]);

#endif
