/* SPDX-License-Identifier: Apache-2.0 */
/* Float64 counterparts of the analysis stages, from their textbook definitions. */
#ifndef TRIM3R_TESTS_ORACLE_ANALYSIS_H
#define TRIM3R_TESTS_ORACLE_ANALYSIS_H

#include <stddef.h>
#include <stdint.h>

#include "oracle_raster.h"
#include "trim3r.h"

/* ---- pointmap ------------------------------------------------------------------------------------ */

/* Scene coordinates of pixel (x, y) at camera depth z (scene units). */
void oracle_unproject(const oracle_camera *camera, double x, double y, double z, double point[3]);

/* ---- K-means ------------------------------------------------------------------------------------- */

enum { ORACLE_DIMENSIONS = 6 };

/* Returns the mean over the points of the squared distance to the nearest centre; stores its index in labels (may be
 * NULL). */
double oracle_kmeans_assign(const double *points, size_t count, const double *centres, size_t k, uint32_t *labels);
/* Returns the mean squared distance of the points to the centres that their labels name. */
double oracle_kmeans_msd(const double *points, size_t count, const double *centres, const uint32_t *labels);
/* Runs Lloyd's iteration on the centres, in place, until nothing moves or for `most` rounds; an empty cluster keeps
 * its centre. Returns the mean squared distance reached. */
double oracle_kmeans_lloyd(const double *points, size_t count, double *centres, size_t k, uint32_t most);

/* ---- wavelet ------------------------------------------------------------------------------------- */

/* Transforms with orthonormal gain, periodized, in place to [LL | H; V | D] (H high in x, V high in y), the LL quarter
 * split again. The sides are divisible by 2^levels. CDF 5/3: the biorthogonal pair scaled by sqrt 2 and 1 / sqrt 2. */
void oracle_wavelet(double *plane, size_t width, size_t height, uint32_t levels, t3r_wavelet kind);
/* Returns the sum of |coefficient| outside the LL quarter, each weighted by the pixels that it covers (4^level). */
double oracle_wavelet_energy(const double *plane, size_t width, size_t height, uint32_t levels);

#endif
