/* SPDX-License-Identifier: Apache-2.0 */
/* A Gaussian of a file as one camera sees it: the colour of its harmonics, and the opacity of mip-splatting. It needs
 * no C library, so that the page of `trim3r view` draws by the same code. */
#ifndef TRIM3R_TOOLS_SEEN_GAUSSIAN_H
#define TRIM3R_TOOLS_SEEN_GAUSSIAN_H

#include <stdbool.h>

#include "core/scene_frame.h"
#include "trim3r.h"

/* Traits that Gaussians of the runtime lack. */
typedef struct seen_traits {
    uint32_t degree; /* of the harmonics, 0..3; 0: the colour is the Gaussian's */
    /* Opacities are those of mip-splatting ("antialiased"): a Gaussian that is widened to the size of a pixel is made
     * as much fainter (Yu et al. 2024, "Mip-Splatting", section 4.2). */
    bool mip;
} seen_traits;

/* A camera in the frame of the scene. */
typedef struct seen_from {
    t3r_camera camera;
    t3r_pose pose;
    uint32_t width, height;
} seen_from;

/* Returns T3R_ERR_CAMERA as t3r_render() would. */
t3r_status seen_from_camera(const t3r_camera *camera, const t3r_scene_frame *frame, uint32_t width, uint32_t height,
                            seen_from *out);
/* Gives the Gaussian the colour and the opacity that the camera sees; harmonics_q12: its own (t3r_harmonics_colour()).
 */
t3r_status seen_gaussian(const seen_traits *traits, const int16_t *harmonics_q12, const seen_from *from,
                         t3r_gaussian *gaussian);

#endif
