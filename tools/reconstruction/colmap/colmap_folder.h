/* SPDX-License-Identifier: Apache-2.0 */
/* Writes a scene's points and context views as a COLMAP model in text, a start for other optimisers: DIR/images/, and
 * cameras.txt, images.txt and points3D.txt in DIR/sparse/0/, where 3D Gaussian Splatting and gsplat look for them.
 *
 * COLMAP's conventions (colmap.github.io/format.html): poses are world-to-camera, quaternion w x y z first; cameras
 * look along +z, x right, y down; the top-left pixel's centre is at (0.5, 0.5). */
#ifndef TRIM3R_TOOLS_COLMAP_FOLDER_H
#define TRIM3R_TOOLS_COLMAP_FOLDER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cli/files/whole_folder.h"
#include "trim3r.h"

/* A context view that the scene was built from. */
typedef struct colmap_view {
    uint32_t frame;    /* index within the recording; gives the picture's name */
    t3r_camera camera; /* undistorted */
    uint32_t width, height;
    uint8_t *rgb; /* width x height x 3 */
} colmap_view;

typedef struct colmap_model {
    const colmap_view *views;
    uint32_t view_count;
    const t3r_scene *scene;
    bool local;   /* positions relative to the scene frame's origin, not the world's */
    bool sourced; /* each Gaussian is observed in its source view, one of `views`; else nowhere */
} colmap_model;

/* Writes pictures, cameras, poses, and a point for the mean of each Gaussian of a surface, with its colour. A point has
 * one observation, the projection of the mean in its source view, with error 0; or none, with error -1. The folder must
 * have been begun, and is not committed here. Returns 0, or -1 with "path: why" in error[]. */
int colmap_folder_write(whole_folder *folder, const colmap_model *model, char *error, size_t error_bytes);

#endif
