/* SPDX-License-Identifier: Apache-2.0 */
/* Camera faults, as changes of a capture: the context views change, the target stays as recorded (huge coordinates
 * move its camera along). */
#ifndef TRIM3R_TOOLS_STRESS_PERTURBATION_H
#define TRIM3R_TOOLS_STRESS_PERTURBATION_H

#include <stdbool.h>
#include <stdint.h>

#include "study/stress/capture.h"

#define STRESS_GRADES 3u

typedef struct perturbation {
    const char *name, *unit;
    double strength[STRESS_GRADES]; /* ascending; 0 would change nothing */
    bool each_frame;                /* drawn anew in each capture of a still scene, as noise is */
    const char *about;              /* text for --help */
    /* False without memory, the capture then half done. */
    bool (*apply)(stress_capture *capture, double strength, uint32_t seed);
} perturbation;

/* Stable order; NULL past the last. */
const perturbation *stress_perturbation(uint32_t index);

/* The noise of any camera in a still scene: STRESS_STILL_LEVELS levels, and depth noise of STRESS_STILL_DEPTH % */
#define STRESS_STILL_LEVELS 2.0
#define STRESS_STILL_DEPTH 0.2
void stress_still_noise(stress_capture *capture, uint32_t seed);

/* The changes themselves; a strength of 0 changes nothing. ----------------------------------------------------------
 */

/* perturb_colour.c: deviation in levels; deviation in pixels; stops between even and odd views, half up, half down,
 * with a display's gamma of 2.2; the same of red, and the contrary of blue */
bool perturb_noise(stress_capture *capture, double levels, uint32_t seed);
bool perturb_blur(stress_capture *capture, double pixels, uint32_t seed);
bool perturb_exposure(stress_capture *capture, double stops, uint32_t seed);
bool perturb_white(stress_capture *capture, double stops, uint32_t seed);

/* perturb_depth.c: deviation in percent of the depth; one pixel in pitch x pitch keeps its depth; percent of the pixels
 * without depth, in discs; percent without depth, each for itself; percent that depth is too large; percent of the
 * pixels measured at one step, or at the last step */
bool perturb_depth_noise(stress_capture *capture, double percent, uint32_t seed);
bool perturb_lattice(stress_capture *capture, double pitch, uint32_t seed);
bool perturb_blobs(stress_capture *capture, double percent, uint32_t seed);
bool perturb_dropouts(stress_capture *capture, double percent, uint32_t seed);
bool perturb_depth_scale(stress_capture *capture, double percent, uint32_t seed);
bool perturb_near(stress_capture *capture, double percent, uint32_t seed);
bool perturb_far(stress_capture *capture, double percent, uint32_t seed);

/* perturb_camera.c: each context camera turned by so many degrees about an axis and moved by so many percent of the
 * median depth; degrees that the camera yaws from the first row to the last; percent that the focal length is said too
 * large; all cameras moved by 10^exponent world units along each axis */
bool perturb_pose(stress_capture *capture, double amount, uint32_t seed);
bool perturb_rolling(stress_capture *capture, double degrees, uint32_t seed);
bool perturb_intrinsics(stress_capture *capture, double percent, uint32_t seed);
bool perturb_huge(stress_capture *capture, double exponent, uint32_t seed);

/* perturb_frame.c: percent of the rows, from the top, in one colour; the other views become the first (1: with its
 * depth and pose, 2: with its depth, 3: its picture alone); left is right (1: the last view's picture, 2: its depth
 * too, 3: both of all views) */
bool perturb_black(stress_capture *capture, double percent, uint32_t seed);
bool perturb_white_frame(stress_capture *capture, double percent, uint32_t seed);
bool perturb_one_colour(stress_capture *capture, double percent, uint32_t seed);
bool perturb_identical(stress_capture *capture, double kind, uint32_t seed);
bool perturb_mirrored(stress_capture *capture, double kind, uint32_t seed);

#endif
