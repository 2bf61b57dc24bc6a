/* Pointmaps as the depth of a folder's frames. */
#ifndef TRIM3R_TOOLS_IMPORT_POINTMAPS_H
#define TRIM3R_TOOLS_IMPORT_POINTMAPS_H

#include "pictures/picture.h"
#include "import/pointmaps/pointmaps.h"
#include "import/folders/posed_frame.h"

typedef struct pointmap_options {
    const char *file;        /* one .npz for all frames, in their order; NULL: each frame's pointmap_path */
    double confidence_least; /* points with less become no depth */
    double depth_unit;       /* 0: the folder's, else a power of two, so that the median depth has 4096 to 8192 steps */
    bool resect;             /* all poses from the points, whatever else gives some */
} pointmap_options;

typedef struct pointmap_source {
    pointmap_options options;
    const char *directory;
    const posed_folder *folder;
    pointmaps stack; /* of options.file */
    motion *cameras; /* a frame: camera to the points' frame */
    motion first;    /* the pose that the folder gives its first frame, if it does */
    bool first_posed;
    uint32_t count; /* frames that have a pointmap */
    /* a frame whose pose is in the folder's world, and one in the points' frame; NULL = none */
    const char *in_folder, *in_points;
    double
        worst_px; /* of poses from points: the largest root mean square error, pixels of the map; 0 = there are none */
} pointmap_source;

/* Reads all pointmaps once, a view at a time: checks them, gives frames the poses and intrinsics that the files hold
 * (they are what the points were made with, so they win over the folder's), takes the missing poses from the points,
 * and settles the folder's depth unit. Without poses in the file the points are in the first frame's camera. Poses in
 * two worlds, the folder's and the points', are refused, unless a file's pose is the folder's too. 0, or -1 with a
 * reason in error[]; pointmap_source_close() in either case. */
int pointmap_source_open(pointmap_source *source, const char *directory, const pointmap_options *options,
                         posed_folder *folder, char *error, size_t error_bytes);
void pointmap_source_close(pointmap_source *source);

/* Depth of frame `index` in steps of the folder's unit, rounded to the nearest, as 16-bit grey; what lies behind the
 * camera, beyond 65535 steps or below the confidence is 0. No samples when the frame has no pointmap. */
int pointmap_source_depth(pointmap_source *source, uint32_t index, picture *depth, char *error, size_t error_bytes);

#endif
