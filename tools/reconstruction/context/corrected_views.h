/* SPDX-License-Identifier: Apache-2.0 */
/* Finds the pose and the exposure with which a view is drawn as its camera saw it, from the context views around it.
 *
 * A build corrects the poses of its context views (`align`) and brings them to one exposure (`exposure`). A camera
 * among them was placed by the same tracker and exposed by the same control, so it is off as they are. Its correction
 * is the mean of theirs, weighted by nearness. Of two views nobody knows which is off, so it takes three. */
#ifndef TRIM3R_TOOLS_CORRECTED_VIEWS_H
#define TRIM3R_TOOLS_CORRECTED_VIEWS_H

#include <stddef.h>
#include <stdint.h>

#include "reconstruction/reconstruction.h"
#include "recording/recording.h"

/* The context views of a build, as they were given and as it used them. */
typedef struct corrected_views {
    uint32_t count; /* 0 = nothing is known, and cameras stay as they are */
    double unit;    /* of the scene, in world units: about the median depth */
    t3r_camera given[T3R_MAX_VIEWS], used[T3R_MAX_VIEWS];
    uint16_t gain_q14[T3R_MAX_VIEWS][3];
} corrected_views;

/* Reads the given poses from the recording. *views has no views if the build used fewer than three or has no cameras.
 * Returns an exit status of cli.h. */
int corrected_views_of(const t3r_recording *recording, const char *path, const reconstruction_account *account,
                       corrected_views *views);

/* Returns the camera with the pose that belongs to the scene. gain: factors of r g b that bring the scene's colours to
 * the camera's exposure. */
t3r_camera corrected_views_camera(const corrected_views *views, const t3r_camera *camera, double gain[3]);

/* Multiplies r g b of a picture by the factors. */
void corrected_views_expose(uint8_t *rgb, size_t pixels, const double gain[3]);

#endif
