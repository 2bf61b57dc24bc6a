/* SPDX-License-Identifier: Apache-2.0 */
/* Features of pictures, their matches, and the motions that these show: a module of OpenCV, loaded on demand. */
#ifndef TRIM3R_TOOLS_POSING_OPENCV_MODULE_H
#define TRIM3R_TOOLS_POSING_OPENCV_MODULE_H

#ifdef __cplusplus
extern "C" {
#endif

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "geometry/rigid.h"

#define FEATURES_MOST 4000u
#define DESCRIPTOR_BYTES 128

/* Features of a picture, at most FEATURES_MOST. */
typedef struct pose_features {
    uint32_t count;
    double (*rays)[2];                        /* x and y at depth 1, the lens undone */
    double *depth;                            /* along z in world units; 0 = unknown, or at an edge */
    uint8_t (*descriptors)[DESCRIPTOR_BYTES]; /* SIFT's, as square roots */
    double focal;                             /* mean focal length, pixels of the picture that is worked on */
    double enlarged;                          /* pixels of that picture to one of the frame */
} pose_features;

/* Features of two pictures that look alike. */
typedef struct pose_match {
    uint32_t a, b;
} pose_match;

typedef struct relative_pose {
    rigid there;         /* from the first camera's axes to the second's; |position| = 1 without metric */
    bool metric;         /* its length is in the depths' unit */
    pose_match *matches; /* the inliers; there is room for all matches */
    uint32_t count;
    double pixels;                          /* root mean square error of the inliers */
    double turn_degrees, direction_degrees; /* standard deviations of the rotation and of the direction */
} relative_pose;

/* Every function returns 0, or -1 with a reason in error[]. The same input gives the same result. */
typedef struct pose_module {
    const char *version; /* "OpenCV" and its number */
    /* Finds features: count, descriptors, and positions in pixels in rays; (0, 0) is the centre of the first pixel. */
    int (*find)(const uint8_t *grey, uint32_t width, uint32_t height, pose_features *out, char *error,
                size_t error_bytes);
    /* Finds the matches; matches[] has room for FEATURES_MOST. */
    int (*match)(const pose_features *a, const pose_features *b, pose_match *matches, uint32_t *count, char *error,
                 size_t error_bytes);
    /* Finds the motion that the matches show: from colour, or by depth (metric). It refuses too few matches, and from
     * colour no parallax, two motions that explain the matches about equally, and an unsure direction. */
    int (*relate)(const pose_features *a, const pose_features *b, const pose_match *matches, uint32_t count,
                  bool metric, relative_pose *out, char *error, size_t error_bytes);
    /* Finds the pose (camera to the points' frame) from which points[] are seen on rays[], although up to half of them
     * are wrong. A right one misses its ray by at most `band` at depth 1. *off: root mean square error of these. */
    int (*resect)(const double (*points)[3], const double (*rays)[2], uint32_t count, double band, rigid *camera,
                  double *off, char *error, size_t error_bytes);
} pose_module;

/* Loads the module. Returns NULL, with what is missing in error[], where it cannot. */
const pose_module *pose_module_load(char *error, size_t error_bytes);

extern const pose_module t3r_shim; /* in the module */

#ifdef __cplusplus
}
#endif
#endif
