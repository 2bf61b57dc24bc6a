/* SPDX-License-Identifier: Apache-2.0 */
/* A sketch of a scene: a sample of its Gaussians, which stands for all of them while the camera moves. Priority
 * sampling (Duffield, Lund and Thorup 2007, "Priority sampling for estimation of arbitrary subset sums") weighs a
 * Gaussian by opacity times area. Those that outweigh the sample's threshold are drawn as they are; each of the others
 * that is drawn stands for several, and is widened until its weight reaches the threshold. */
#ifndef TRIM3R_TOOLS_SKETCH_H
#define TRIM3R_TOOLS_SKETCH_H

#include <stddef.h>

#include "kernels/kernels.h"
#include "trim3r.h"

#define SKETCH_MOST 262144u /* Gaussians of a sketch */

/* Indices of Gaussians by falling priority. Each prefix is a sample of the scene. */
typedef struct sketch {
    uint32_t *keys[2], *indices[2], *histogram;
    uint32_t side;  /* of keys and indices that is in order */
    uint32_t count; /* Gaussians that were weighed */
} sketch;

/* Returns the bytes of memory for so many Gaussians. */
size_t sketch_bytes(uint32_t gaussians);

/* Takes the memory, aligned to 4. */
void sketch_init(sketch *s, void *memory, uint32_t gaussians);

/* Add each Gaussian of the scene after sketch_begin(), then put them in order. */
void sketch_begin(sketch *s);
void sketch_weigh(sketch *s, uint32_t index, const t3r_gaussian *gaussian);
void sketch_arrange(sketch *s, const t3r_kernels *kernels);

/* Returns the index of a Gaussian by its rank. */
uint32_t sketch_index(const sketch *s, uint32_t rank);

/* Widens a Gaussian of the sample of the first `drawn`, which are fewer than all, to its share of the scene. */
void sketch_widen(const sketch *s, uint32_t drawn, t3r_gaussian *gaussian);

#endif
