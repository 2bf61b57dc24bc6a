/* Frames of a posed folder: what every reader of one fills in, and what is made of it. */
#ifndef TRIM3R_TOOLS_POSED_FRAME_H
#define TRIM3R_TOOLS_POSED_FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cli/tables/text_list.h"
#include "import/depth/raw_depth.h"
#include "geometry/rigid.h"
#include "recording/recording.h"

/* What a folder says of a camera; a number that it does not give is NAN. Pixels, with the principal point measured
 * from the corner of the top-left pixel, whose centre is thus at (0.5, 0.5). */
typedef struct posed_intrinsics {
    double width, height;           /* of the picture */
    double grid_width, grid_height; /* of the pixels that fx ... cy are measured in; 0 = the picture's */
    double fx, fy, cx, cy;
    double angle_x, angle_y; /* full field of view in radians, the fallback for fx and fy */
    t3r_distortion distortion;
    double coefficients[5]; /* in the order of t3r_distortion */
} posed_intrinsics;

typedef struct posed_frame {
    char *image;                 /* path, relative to the folder as the folder spells it */
    char *depth;                 /* likewise; NULL = none */
    raw_depth depth_raw;         /* how depth is stored where it is no picture */
    uint16_t no_depth;           /* a sample of it that stands for none, as 0 does; 0: there is no other */
    char *pointmap, *confidence; /* likewise: depth made elsewhere (pointmaps.h) */
    bool posed;                  /* false: the pose is the identity */
    posed_intrinsics intrinsics;
    posed_intrinsics depth_lens; /* of the depth picture's camera; fx 0: it sees what colour's sees */
    rigid from_depth;            /* from that camera to colour's, in steps of depth; only where depth_lens has an fx */
    rigid pose;                  /* camera to world, in world units */
} posed_frame;

typedef struct posed_folder {
    const char *kind; /* "transforms.json", as the table of posed_folder.c has it */
    posed_frame *frames;
    uint32_t frame_count;
    t3r_triplet *triplets;
    uint32_t triplet_count;
    double depth_unit; /* world units a step; 0.001 where no frame has depth and none is given */
    bool depth_unit_given;
    double exr_length;  /* world units that a 1 of depth in OpenEXR is; 0: the folder does not say, it is 1 */
    text_list left_out; /* "picture: why", one a picture that is no frame */
    text_list remarks;  /* what a user should know of how the folder was read */
} posed_folder;

typedef struct posed_folder_options {
    const double *intrinsics;  /* fx fy cx cy [k1 k2 p1 p2 k3], cx and cy from the top-left pixel's centre: of folders
                                  that do not hold them */
    uint32_t intrinsics_count; /* 0, 4 or 9 */
    double depth_unit;         /* of depth whose steps no file tells; 0 = not given */
    bool without_poses;        /* frames may lack a pose, and a folder may hold pictures alone */
    bool without_intrinsics;   /* they may lack these as well: NAN then */
} posed_folder_options;

void posed_folder_close(posed_folder *folder);
/* What one frame holds; the frame becomes empty. */
void posed_frame_free(posed_frame *frame);

/* The frame's camera for a picture of width x height pixels, fit for the recorder: sizes agree, gaps filled (focal
 * length from the field of view, principal point in the middle), numbers finite. Pixel (0, 0) is the centre of the
 * top-left pixel from here on. 0, or -1 with "field: what" in error[]. */
int posed_frame_camera(const posed_frame *frame, uint32_t width, uint32_t height, t3r_recorded_camera *camera,
                       char *error, size_t error_bytes);

/* Of fx fy cx cy [k1 k2 p1 p2 k3]. */
posed_intrinsics posed_intrinsics_of(const double numbers[9]);
/* DIR/NAME, or NAME when absolute, on the heap; NULL when out of memory. */
char *posed_path(const char *directory, const char *name);
bool posed_exists(const char *directory, const char *name);

#endif
