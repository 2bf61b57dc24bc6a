/* SPDX-License-Identifier: Apache-2.0 */
/* A float64 rasterizer as the reference for the integer one: the definitions of the 3DGS renderers (EWA projection,
 * 0.3 px^2 low-pass, alpha in [1/255, 0.99], front-to-back), written independently of the runtime's code. */
#ifndef TRIM3R_TESTS_ORACLE_RASTER_H
#define TRIM3R_TESTS_ORACLE_RASTER_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

/* Nothing is drawn below this camera z, in scene units. */
#define ORACLE_NEAR (1.0 / 32.0)
/* Bound of each entry of the projected factor, in pixels; larger splats look alike on any target (SPEC.md, "Raster").
 */
#define ORACLE_MOST_PIXELS 4096.0
/* Bound of each entry of the factor along the axis, in parts of the mean's depth. */
#define ORACLE_DEEPEST 16.0
/* The allowed error of a renderer's transmittance when it decides on the median depth. */
#define ORACLE_DEPTH_MARGIN 0.003

/* Covariance = factor factor^T: stays positive semi-definite and exact for needles. */
typedef struct oracle_gaussian {
    double position[3]; /* scene units */
    double factor[9];   /* row-major, scene units */
    double colour[3];   /* 0..1 */
    double opacity;     /* 0..1 */
} oracle_gaussian;

typedef struct oracle_camera {
    uint32_t width, height;
    double fx, fy, cx, cy; /* pixels; (0, 0) is the centre of the top-left pixel */
    double rotation[9];    /* row-major, camera to scene */
    double position[3];    /* scene units */
} oracle_camera;

/* width x height values (rgb: 3 each); oracle_image_free(). */
typedef struct oracle_image {
    uint32_t width, height;
    double *rgb;           /* 0..1 */
    double *transmittance; /* 0..1 */
    double *depth;         /* that of the splat's surface where transmittance falls below 1/2; 0 = none */
    double *depth_slack;   /* error that is allowed there, from the steps of the conic */
    double *depth_first;   /* where it falls below 1/2 + ORACLE_DEPTH_MARGIN: valid, as all between it and depth_last */
    double *depth_last;    /* where it falls below 1/2 - ORACLE_DEPTH_MARGIN; HUGE_VAL: no depth is valid, too */
    uint32_t drawn;        /* number of Gaussians that are not culled */
} oracle_image;

void oracle_from_t3r(const t3r_gaussian *from, oracle_gaussian *to);
/* Returns the view of a t3r_camera of a scene in the given frame, for a target of width x height. */
oracle_camera oracle_camera_from_t3r(const t3r_camera *from, const t3r_scene_frame *frame, uint32_t width,
                                     uint32_t height);

/* Renders in order of camera z rounded to Q20, then index. Ends the program when out of memory, like the whole oracle.
 */
void oracle_render(const oracle_gaussian *gaussians, size_t count, const oracle_camera *camera, oracle_image *image);
void oracle_image_free(oracle_image *image);

/* Reads a degree-0 3DGS .ply (float32, little-endian) as doubles, moved into the frame; NULL if it cannot be read.
 * colours are clamped to 0..1, the range of a display. Free with free(). */
oracle_gaussian *oracle_read_ply(const char *path, const t3r_scene_frame *frame, size_t *count);

/* Returns the PSNR in dB of 8-bit RGB against the oracle rounded to 8 bits, over all pixels; 99 when equal. */
double oracle_psnr(const oracle_image *image, const uint8_t *rgb, size_t stride_bytes);

#endif
