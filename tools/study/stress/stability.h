/* SPDX-License-Identifier: Apache-2.0 */
/* Whether a still scene stays the same scene: which pixels are retained, and where their Gaussians stand, from one
 * noisy capture to the next. */
#ifndef TRIM3R_TOOLS_STRESS_STABILITY_H
#define TRIM3R_TOOLS_STRESS_STABILITY_H

#include "study/stress/run.h"

/* What is guaranteed of the method trim3r under the noise of a still scene (perturbation.h), where there are as many
 * Gaussians as SuperClusters and at least STRESS_JUDGED_LEAST: with fewer, chance says what gets one.
 *
 * The share of the retained pixels that change is at most STRESS_MASK_CHANGED_MOST, and with n Gaussians a SuperCluster
 * at most STRESS_MASK_CHANGED_ONE / sqrt(n): those change that stand at the edge of a quota, and the more a quota holds
 * the smaller their share. Measured over room, drawn scenes and recorded test scenes, 48x48 to 256x256, 1 to 100 %
 * kept, with 300 SuperClusters: at most 0.44 / sqrt(n). Where the number of SuperClusters is left to the runtime, which
 * takes fewer, the bound is that of STRESS_JUDGED_CLUSTERS all the same: quotas are few then, and what changes stands
 * at the edge of a cell of the sampling pattern. Measured on recorded test scenes, 2 to 50 % kept: at most 0.39 /
 * sqrt(n) with that n.
 *
 * Half of the Gaussians of pixels retained twice move by at most STRESS_MOTION_MOST of their spacing beyond what the
 * depth's own noise moves them: refinement follows colours, where there are none, or where views contradict each other,
 * it follows their noise. Measured likewise: 0.52 on a blank wall at a grazing angle, 0.38 elsewhere. The median, for a
 * mean would tell of the few that leap from one surface to another, where depth has holes. */
#define STRESS_JUDGED_LEAST 64
#define STRESS_JUDGED_CLUSTERS 300   /* the paper's */
#define STRESS_MASK_CHANGED_MOST 0.5 /* share of the retained pixels */
#define STRESS_MASK_CHANGED_ONE 0.6  /* likewise */
#define STRESS_MOTION_MOST 0.75      /* as a share of the spacing of retained pixels */

/* Shares: of the retained pixels with so many Gaussians; of the spacing, of which the depth's noise is `noise`. */
double stress_mask_changed_most(double gaussians, uint32_t clusters);
double stress_motion_most(double noise);

/* Returns the median motion of a Gaussian between two captures that the depth's noise explains, as a share of the
 * spacing of so many Gaussians; 0 without Gaussians. */
double stress_still_motion(const stress_capture *capture, double gaussians);

/* Fills mask_changed and motion of a case's measured unperturbed rows (stress_row_count()), and marks rows beyond
 * the bounds as broken. +finetune has the retained pixels of its method without +finetune. Needs at least two
 * captures. Returns an exit status of cli.h. */
int stress_stability(stress_row *rows, const stress_case *c, const stress_contest *contest);

/* Marks a row of trim3r as broken if mask_changed or motion is beyond its bounds; noise: stress_still_motion(). */
void stress_judge_still(stress_row *row, uint32_t clusters, double noise);

#endif
