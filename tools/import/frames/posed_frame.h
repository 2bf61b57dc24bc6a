/* SPDX-License-Identifier: Apache-2.0 */
/* Frames of a posed folder: the fields that every reader fills in, and values derived from them. */
#ifndef TRIM3R_TOOLS_POSED_FRAME_H
#define TRIM3R_TOOLS_POSED_FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cli/text/text_list.h"
#include "geometry/rigid.h"
#include "import/depth/raw_depth.h"
#include "import/frames/left_out.h"
#include "import/poses/intrinsics.h"
#include "pictures/picture_border.h"
#include "recording/recording.h"

/* A camera as a folder describes it; missing numbers are NAN. In pixels, with the principal point measured from the
 * corner of the top-left pixel, whose centre is thus at (0.5, 0.5). */
typedef struct posed_intrinsics {
    double width, height;           /* of the picture */
    double grid_width, grid_height; /* size of the pixel grid of fx ... cy; 0 = the picture's */
    double fx, fy, cx, cy;
    double angle_x, angle_y; /* full field of view in radians, the fallback for fx and fy */
    t3r_distortion distortion;
    double coefficients[8]; /* in the order of t3r_distortion; for T3R_DISTORTION_RADTAN k4 k5 k6 follow */
} posed_intrinsics;

typedef struct posed_frame {
    char *image;                 /* path relative to the folder, as the folder spells it */
    char *depth;                 /* likewise; NULL = none */
    char *mask;                  /* likewise: a picture that is black where neither is valid */
    raw_depth depth_raw;         /* storage of depth that is not a picture */
    uint16_t no_depth;           /* a depth sample that means "none", besides 0; 0: there is no other */
    char *pointmap, *confidence; /* likewise: depth from pointmaps (pointmaps.h) */
    bool posed;                  /* false: the pose is the identity */
    posed_intrinsics intrinsics;
    posed_intrinsics depth_lens; /* lens of the depth camera; fx 0: same view as colour */
    rigid from_depth;            /* from that camera to colour's, in depth steps; only if depth_lens has an fx */
    bool as_stored;              /* the camera sees the pixels as they are stored, whatever orientation EXIF states */
    bool upright;                /* the pose is that of the picture turned by EXIF: it was estimated from it */
    picture_inner inner;         /* the part of the upright picture that is used; width 0: all of it */
    rigid pose;                  /* camera to world, in world units */
    bool rejected;               /* cannot be used (rejected.h) */
    char *wrong;                 /* the reason; NULL if memory was out */
} posed_frame;

typedef struct posed_folder {
    const char *kind; /* "transforms.json", as in the table of posed_folder.c */
    posed_frame *frames;
    uint32_t frame_count;
    t3r_triplet *triplets;
    uint32_t triplet_count;
    double depth_unit; /* world units per step; 0.001 if no frame has depth and none is given */
    bool depth_unit_given;
    double exr_length; /* world units per 1 of depth in OpenEXR; 0: unspecified, taken as 1 */
    left_out left_out;
    char focal[128];   /* where focal lengths that the folder did not give came from; "" = it gave them */
    text_list remarks; /* remarks for the user on how the folder was read */
} posed_folder;

typedef struct posed_folder_options {
    const double *intrinsics; /* the INTRINSICS_NUMBERS numbers of intrinsics_of_text(), for folders without intrinsics;
                                 NULL = not given */
    double depth_unit;        /* for depth whose step no file gives; 0 = not given */
    bool without_poses;       /* frames may lack a pose, and a folder may hold only pictures */
    bool without_intrinsics;  /* frames may lack intrinsics, which are NAN then */
} posed_folder_options;

void posed_folder_close(posed_folder *folder);
/* Frees a frame's contents; the frame becomes empty. */
void posed_frame_free(posed_frame *frame);

/* Whether a picture of one size may show the same view as one of the other: their aspect ratios agree within a few
 * percent, as sides are rounded, by networks to whole patches. */
bool posed_same_aspect(double width, double height, double other_width, double other_height);

/* Makes the frame's camera for a picture of width x height pixels, ready for the recorder: checks sizes, fills gaps
 * (focal length from the field of view, principal point in the middle), checks that numbers are finite and fit the
 * picture. Pixel (0, 0) is the centre of the top-left pixel from here on. Returns 0, or -1 with "field: what" in
 * error[]. */
int posed_frame_camera(const posed_frame *frame, uint32_t width, uint32_t height, t3r_recorded_camera *camera,
                       char *error, size_t error_bytes);

/* Makes intrinsics from the numbers of intrinsics_of_text(). */
posed_intrinsics posed_intrinsics_of(const double numbers[INTRINSICS_NUMBERS]);
/* Makes intrinsics of a pinhole. */
posed_intrinsics posed_intrinsics_pinhole(double fx, double fy, double cx, double cy);
/* Makes those of a frame whose intrinsics nothing gives. */
posed_intrinsics posed_intrinsics_unknown(void);
/* Returns DIR/NAME, or NAME when absolute, on the heap; NULL when out of memory. */
char *posed_path(const char *directory, const char *name);
bool posed_exists(const char *directory, const char *name);

#endif
