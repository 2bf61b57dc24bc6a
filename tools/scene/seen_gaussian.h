/* SPDX-License-Identifier: Apache-2.0 */
/* A Gaussian of a file as one camera sees it: the colour of its harmonics, the opacity of mip-splatting, and its place
 * where the scene's frame cannot show it. It needs no C library, so that the page of `trim3r view` draws by the same
 * code. */
#ifndef TRIM3R_TOOLS_SEEN_GAUSSIAN_H
#define TRIM3R_TOOLS_SEEN_GAUSSIAN_H

#include <stdbool.h>

#include "geometry/view_frame.h"
#include "trim3r.h"

/* Traits that Gaussians of the runtime lack. */
typedef struct seen_traits {
    uint32_t degree; /* of the harmonics, 0..3; 0: the colour is the Gaussian's */
    /* Opacities are those of mip-splatting ("antialiased"): a Gaussian that is widened to the size of a pixel is made
     * as much fainter (Yu et al. 2024, "Mip-Splatting", section 4.2). */
    bool mip;
    bool is_spread; /* views take frames of their own, with units of 2^-finer of the scene's */
    uint32_t finer;
} seen_traits;

/* A camera, and the frame in which it sees the scene. */
typedef struct seen_from {
    t3r_camera camera;
    uint32_t width, height;
    bool is_own; /* a frame of the view's own: the scene is spread, or the camera outside its frame */
    view_frame view;
    t3r_scene_frame frame;
    t3r_pose pose;
} seen_from;

void seen_from_camera(const t3r_camera *camera, const t3r_scene_frame *frame, const seen_traits *traits, uint32_t width,
                      uint32_t height, seen_from *out);
/* Returns a depth of a picture in units of the frame that it was drawn in */
static inline double seen_depth(const seen_from *from, uint32_t depth_q20)
{
    const double depth = depth_q20 * 0x1p-20;
    return from->is_own ? view_frame_depth(depth) : depth;
}
/* Whether Gaussians are seen in another way than the scene has them. */
static inline bool seen_differs(const seen_traits *traits, const seen_from *from)
{
    return traits->degree > 0 || traits->mip || from->is_own;
}
/* Gives the Gaussian the place, the colour and the opacity that the camera sees. times: as in view_frame_place();
 * harmonics_q12: its own (t3r_harmonics_colour()). */
t3r_status seen_gaussian(const seen_traits *traits, double times, const int16_t *harmonics_q12, const seen_from *from,
                         t3r_gaussian *gaussian);

#endif
