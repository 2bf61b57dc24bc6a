/* SPDX-License-Identifier: Apache-2.0 */
/* Camera faults, as changes of a capture: the context views change, the target stays as recorded (only huge
 * coordinates move its camera, too). */
#ifndef TRIM3R_TOOLS_STRESS_PERTURBATION_H
#define TRIM3R_TOOLS_STRESS_PERTURBATION_H

#include <stdbool.h>
#include <stdint.h>

#include "study/stress/capture.h"

#define STRESS_GRADES 3u

typedef struct perturbation {
    const char *name, *unit;
    double strength[STRESS_GRADES]; /* ascending; 0 would change nothing */
    bool each_frame;                /* drawn again for each capture of a still scene, like noise */
    const char *about;              /* text for --help */
    /* Returns false if out of memory; the capture is then partly changed. */
    bool (*apply)(stress_capture *capture, double strength, uint32_t seed);
} perturbation;

/* Returns perturbation number `index`, in a stable order; NULL past the last. */
const perturbation *stress_perturbation(uint32_t index);

/* The noise of any camera in a still scene: STRESS_STILL_LEVELS levels, and depth noise of STRESS_STILL_DEPTH % */
#define STRESS_STILL_LEVELS 2.0
#define STRESS_STILL_DEPTH 0.2
void stress_still_noise(stress_capture *capture, uint32_t seed);

/* The perturbations; a strength of 0 changes nothing. ----------------------------------------------------------------
 */

/* perturb_colour.c. In turn: noise, deviation in levels; blur, deviation in pixels; exposure, stops between even and
 * odd views, half up, half down, at a display's gamma of 2.2; white, the same for red and inverted for blue */
bool perturb_noise(stress_capture *capture, double levels, uint32_t seed);
bool perturb_blur(stress_capture *capture, double pixels, uint32_t seed);
bool perturb_exposure(stress_capture *capture, double stops, uint32_t seed);
bool perturb_white(stress_capture *capture, double stops, uint32_t seed);

/* perturb_depth.c. In turn: noise, deviation in percent of the depth; lattice, where one pixel in pitch x pitch keeps
 * its depth; percent of the pixels without depth, in discs; the same, singly; percent by which depth is too large;
 * percent of the pixels measured at one step, or at the last step */
bool perturb_depth_noise(stress_capture *capture, double percent, uint32_t seed);
bool perturb_lattice(stress_capture *capture, double pitch, uint32_t seed);
bool perturb_blobs(stress_capture *capture, double percent, uint32_t seed);
bool perturb_dropouts(stress_capture *capture, double percent, uint32_t seed);
bool perturb_depth_scale(stress_capture *capture, double percent, uint32_t seed);
bool perturb_near(stress_capture *capture, double percent, uint32_t seed);
bool perturb_far(stress_capture *capture, double percent, uint32_t seed);

/* perturb_camera.c. In turn: degrees about an axis that each context camera turns, and percent of the median depth
 * that it moves; degrees of yaw from the first row to the last; percent by which the given focal length is too large;
 * exponent of the offset of all cameras, 10^exponent world units along each axis */
bool perturb_pose(stress_capture *capture, double amount, uint32_t seed);
bool perturb_rolling(stress_capture *capture, double degrees, uint32_t seed);
bool perturb_intrinsics(stress_capture *capture, double percent, uint32_t seed);
bool perturb_huge(stress_capture *capture, double exponent, uint32_t seed);

/* perturb_frame.c. In turn: percent of the rows, from the top, in one colour; all views become the first (1: with its
 * depth and pose, 2: with its depth, 3: picture only); left and right are swapped (1: in the last view's picture, 2:
 * also in its depth, 3: in both of all views) */
bool perturb_black(stress_capture *capture, double percent, uint32_t seed);
bool perturb_white_frame(stress_capture *capture, double percent, uint32_t seed);
bool perturb_one_colour(stress_capture *capture, double percent, uint32_t seed);
bool perturb_identical(stress_capture *capture, double kind, uint32_t seed);
bool perturb_mirrored(stress_capture *capture, double kind, uint32_t seed);

#endif
