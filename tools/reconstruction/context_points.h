/* SPDX-License-Identifier: Apache-2.0 */
/* The context frames of a recording, and the points that they have before a scene is built. */
#ifndef TRIM3R_TOOLS_CONTEXT_POINTS_H
#define TRIM3R_TOOLS_CONTEXT_POINTS_H

#include "reconstruction/reconstruction.h"

/* Valid points, and by stereo the scene's depth in world units, a power of two times 1.5 (0 by sensor). */
typedef struct reconstruction_points {
    uint32_t valid;
    double depth;
} reconstruction_points;

/* Reads the frames that the options choose, the first two by default. r->config gets the working size. */
int reconstruction_read_context(reconstruction *r, const t3r_recording *recording, const char *path,
                                const reconstruction_options *options, t3r_capture_frame *frames);
/* Does the same for a scene from a file, which needs no pictures. */
int reconstruction_views(reconstruction *r, const t3r_recording *recording, const char *path,
                         const reconstruction_options *options);
/* Counts the points of these frames; there must be some. Stereo needs their depth for that, and `counted`, which is all
 * 0, keeps it for the build. The caller closes `counted` in every case. */
int reconstruction_count_points(const reconstruction *r, const t3r_capture_frame *frames, const char *path,
                                const reconstruction_options *options, reconstruction_points *points,
                                reconstruction *counted);
/* Reads and counts. */
int reconstruction_count(reconstruction_points *points, const t3r_recording *recording, const char *path,
                         const reconstruction_options *options);

#endif
