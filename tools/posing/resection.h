/* SPDX-License-Identifier: Apache-2.0 */
/* A camera's pose from places in space and the rays on which it sees them. */
#ifndef TRIM3R_TOOLS_POSING_RESECTION_H
#define TRIM3R_TOOLS_POSING_RESECTION_H

#include <stdint.h>

#include "posing/motion.h"

/* Orthogonal iteration (Lu, Hager, Mjolsness, PAMI 2000) on points[] and rays[] (x and y at depth 1): from random
 * eights of them, from a fixed seed, the one with the least median error, then again and again on the better half of
 * all, so that up to a third may be wrong. *camera: camera to the points' frame; *error: root of the mean square over
 * the better half of the distance at depth 1. 0, or -1 for fewer than 16 points, for points on a line and when memory
 * is out. */
int resect(const double (*points)[3], const double (*rays)[2], uint32_t count, motion *camera, double *error);

#endif
