/* SPDX-License-Identifier: Apache-2.0 */
/* PlayCanvas's SOG, version 2: a zip archive of lossless WebP pictures, a texel per Gaussian, and meta.json, which
 * gives the meaning of their bytes. Positions are 16 bits of a logarithm, scales and colours indices into a
 * codebook. */
#ifndef TRIM3R_TOOLS_SOG_H
#define TRIM3R_TOOLS_SOG_H

#include <stdio.h>

#include "scene/scene_rows.h"

#define SOG_META "meta.json"
#define SOG_VERSION 2

/* The pictures of every scene. */
enum { SOG_MEANS_LOW, SOG_MEANS_HIGH, SOG_SCALES, SOG_ROTATIONS, SOG_COLOURS, SOG_PICTURES };
/* The fourth byte of a rotation: this, plus the index of the omitted component of w x y z. */
#define SOG_ROTATION_TAG 252
/* Centroids of harmonics in a row of their picture; a texel per coefficient. */
#define SOG_CENTROIDS_A_ROW 64u

/* The value of "model" in SOG_META for scenes of mip-splatting. */
#define SOG_MODEL_MIP "antialiased"

/* like scene_format's */
int sog_parse(const uint8_t *bytes, size_t count, const scene_sink *sink, char *error, size_t error_bytes);
int sog_write(FILE *file, const scene_source *source, char *error, size_t error_bytes);

#endif
