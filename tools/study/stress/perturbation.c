/* SPDX-License-Identifier: Apache-2.0 */
#include "study/stress/perturbation.h"

#include <stddef.h>

static const perturbation perturbations[] = {
    {"noise", "levels", {4, 12, 32}, true, "sensor noise: deviation of each sample", perturb_noise},
    {"blur", "px", {1, 2, 4}, false, "defocus: deviation of a Gaussian", perturb_blur},
    {"exposure", "stops", {0.5, 1, 2}, false, "even views brighter, odd ones darker by half", perturb_exposure},
    {"white-balance", "stops", {0.25, 0.5, 1}, false, "even views redder, odd ones bluer", perturb_white},
    {"depth-noise", "%", {0.5, 2, 5}, true, "deviation of each depth, in percent of it", perturb_depth_noise},
    {"depth-lattice", "px", {2, 3, 4}, false, "depth at one pixel of N x N, and no other", perturb_lattice},
    {"depth-blobs", "%", {10, 30, 60}, false, "share of the pixels without depth, in discs", perturb_blobs},
    {"depth-all", "%", {99, 99.9, 100}, false, "share of the pixels without depth, at random", perturb_dropouts},
    {"depth-scale", "%", {2, 5, 15}, false, "depth measured too large", perturb_depth_scale},
    {"pose", "deg+%", {0.25, 1, 3}, false, "each view turned, and moved by % of the median depth", perturb_pose},
    {"rolling-shutter", "deg", {0.5, 2, 5}, false, "yaw from the first row to the last", perturb_rolling},
    {"intrinsics", "%", {2, 5, 15}, false, "calibrated focal length too large", perturb_intrinsics},
    {"black", "%", {25, 50, 100}, false, "share of the rows that are black, from the top", perturb_black},
    {"white", "%", {25, 50, 100}, false, "share of the rows that are white, from the top", perturb_white_frame},
    {"one-colour", "%", {25, 50, 100}, false, "share of the rows in one colour, from the top", perturb_one_colour},
    {"identical", "kind", {1, 2, 3}, false, "copies of the first: 1 all; 2 not its pose; 3 picture", perturb_identical},
    {"mirrored", "kind", {1, 2, 3}, false, "1 the last picture; 2 its depth too; 3 all views", perturb_mirrored},
    {"near", "%", {1, 10, 100}, true, "share of the pixels measured at one step", perturb_near},
    {"far", "%", {1, 10, 100}, true, "share of the pixels measured at 65535 steps", perturb_far},
    {"huge", "10^", {3, 6, 9}, false, "world units from the origin, along each axis", perturb_huge},
};

const perturbation *stress_perturbation(uint32_t index)
{
    return index < sizeof perturbations / sizeof *perturbations ? &perturbations[index] : NULL;
}

void stress_still_noise(stress_capture *capture, uint32_t seed)
{
    (void)perturb_noise(capture, STRESS_STILL_LEVELS, seed);
    (void)perturb_depth_noise(capture, STRESS_STILL_DEPTH, seed + 1);
}
