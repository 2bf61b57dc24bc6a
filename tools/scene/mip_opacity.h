/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes of mip-splatting ("antialiased"): a Gaussian that is widened to the size of a pixel is made as much fainter,
 * so that it looks the same at every resolution (Yu et al. 2024, "Mip-Splatting", section 4.2). */
#ifndef TRIM3R_TOOLS_MIP_OPACITY_H
#define TRIM3R_TOOLS_MIP_OPACITY_H

#include <stdint.h>

#include "scene/splat_camera.h"

/* Returns the opacity with which a camera sees a Gaussian of such a scene, Q15: times the root of the ratio of its
 * determinants in the picture without and with the 0.3 square pixels that the rasterizer adds. */
uint16_t mip_opacity_q15(const t3r_gaussian *gaussian, const splat_camera *camera);

#endif
