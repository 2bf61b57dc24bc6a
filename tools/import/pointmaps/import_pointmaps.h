/* SPDX-License-Identifier: Apache-2.0 */
/* Uses pointmaps as the depth of a folder's frames. */
#ifndef TRIM3R_TOOLS_IMPORT_POINTMAPS_H
#define TRIM3R_TOOLS_IMPORT_POINTMAPS_H

#include "import/frames/posed_frame.h"
#include "import/pointmaps/pointmaps.h"
#include "pictures/picture.h"

typedef struct pointmap_options {
    const char *file;        /* one .npz for all frames, in their order; NULL: each frame's pointmap_path */
    double confidence_least; /* points of lower confidence give no depth */
    double depth_unit;       /* 0: the folder's, else a power of two for which the median depth is 4096 to 8192 steps */
    bool resect;             /* compute all poses from the points, ignoring all others */
} pointmap_options;

typedef struct pointmap_source {
    pointmap_options options;
    const char *directory;
    const posed_folder *folder;
    pointmaps stack; /* for options.file */
    rigid *cameras;  /* one per frame: camera to the points' frame */
    rigid first;     /* the folder's pose of its first frame, if it has one */
    bool first_posed;
    uint32_t count; /* frames that have a pointmap */
    /* a frame with a pose in the folder's world, and one in the points' frame; NULL = none */
    const char *in_folder, *in_points;
    double
        worst_px; /* poses from points: the largest root mean square error, in pixels of the map; 0 = there are none */
} pointmap_source;

/* Reads all pointmaps once, a view at a time, and checks them. Frames get the poses and intrinsics that the files hold,
 * which the points were made with, so they win over the folder's; missing poses are computed from the points. Then
 * chooses the folder's depth unit. Without poses in the file, the points are in the first frame's camera. Poses in two
 * worlds, the folder's and the points', are refused, unless a file's pose is also the folder's. Returns 0, or -1 with a
 * reason in error[]; call pointmap_source_close() in either case. */
int pointmap_source_open(pointmap_source *source, const char *directory, const pointmap_options *options,
                         posed_folder *folder, char *error, size_t error_bytes);
void pointmap_source_close(pointmap_source *source);

/* Computes the depth of frame `index` in steps of the folder's unit, rounded to the nearest, as 16-bit grey. Points
 * behind the camera, beyond 65535 steps or below the confidence give 0. Without a pointmap there are no samples. */
int pointmap_source_depth(pointmap_source *source, uint32_t index, picture *depth, char *error, size_t error_bytes);

#endif
