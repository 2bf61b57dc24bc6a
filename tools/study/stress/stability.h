/* SPDX-License-Identifier: Apache-2.0 */
/* The stability of a still scene from one noisy capture to the next: which pixels are retained, and the motion of
 * their Gaussians. */
#ifndef TRIM3R_TOOLS_STRESS_STABILITY_H
#define TRIM3R_TOOLS_STRESS_STABILITY_H

#include "study/stress/run.h"

/* The guarantees for the method trim3r under the noise of a still scene (perturbation.h). They hold for at least as
 * many Gaussians as SuperClusters and at least STRESS_JUDGED_LEAST; with fewer, chance decides which SuperCluster gets
 * one.
 *
 * The share of the retained pixels that change is at most STRESS_MASK_CHANGED_MOST, and with n Gaussians per
 * SuperCluster at most STRESS_MASK_CHANGED_ONE / sqrt(n): pixels at the edge of a quota change, and the larger the
 * quota, the smaller their share. Measured over room, drawn scenes and recorded test scenes, 48x48 to 256x256, 1 to 100
 * % kept, with 300 SuperClusters: at most 0.44 / sqrt(n). If the runtime chooses the number of SuperClusters, it takes
 * fewer, and the bound is still that of STRESS_JUDGED_CLUSTERS: with few quotas, the changes are at the edges of cells
 * of the sampling pattern. Measured on recorded test scenes, 2 to 50 % kept: at most 0.39 / sqrt(n) with that n.
 *
 * Half of the Gaussians of pixels retained twice move by at most STRESS_MOTION_MOST of their spacing beyond the motion
 * due to the depth's own noise: refinement follows colours, and where there are none, or where views contradict each
 * other, their noise. Measured on the same scenes: 0.52 on a blank wall at a grazing angle, 0.38 elsewhere. The median
 * is used because a mean would be dominated by the few Gaussians that leap from one surface to another at holes in the
 * depth. */
#define STRESS_JUDGED_LEAST 64
#define STRESS_JUDGED_CLUSTERS 300   /* of the paper */
#define STRESS_MASK_CHANGED_MOST 0.5 /* share of the retained pixels */
#define STRESS_MASK_CHANGED_ONE 0.6  /* likewise */
#define STRESS_MOTION_MOST 0.75      /* as a share of the spacing of retained pixels */

/* Return the allowed share of the retained pixels that change with this number of Gaussians, and the allowed motion as
 * a share of the spacing, to which the depth's noise contributes `noise`. */
double stress_mask_changed_most(double gaussians, uint32_t clusters);
double stress_motion_most(double noise);

/* Returns the median motion of a Gaussian between two captures due to the depth's noise, as a share of the spacing of
 * this number of Gaussians; 0 without Gaussians. */
double stress_still_motion(const stress_capture *capture, double gaussians);

/* Fills mask_changed and motion of a case's measured unperturbed rows (stress_row_count()), and marks rows beyond the
 * bounds as broken. +finetune retains the same pixels as its method without it. Needs at least two captures. Returns
 * an exit status of cli.h. */
int stress_stability(stress_row *rows, const stress_case *c, const stress_contest *contest);

/* Marks a row of trim3r as broken if mask_changed or motion is beyond its bounds; noise: stress_still_motion(). */
void stress_judge_still(stress_row *row, uint32_t clusters, double noise);

#endif
