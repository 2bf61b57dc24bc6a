/* Whether a still scene stays the same scene: which pixels are retained, and where their Gaussians stand, from one
 * noisy capture to the next. */
#ifndef TRIM3R_TOOLS_STRESS_STABILITY_H
#define TRIM3R_TOOLS_STRESS_STABILITY_H

#include "stress/measure.h"

/* Bounds for the method trim3r under the noise of a still scene (perturbation.h), beyond which a promise is broken,
 * where there are as many Gaussians as SuperClusters: with fewer, chance says which of them get one. */
#define STRESS_MASK_CHANGED_MOST 0.5 /* share of the retained pixels */
#define STRESS_MOTION_MOST 0.5       /* of the spacing of retained pixels */

/* Fills mask_changed and motion of the unperturbed rows of a case (stress_row_count()) that were measured, and breaks
 * those beyond the bounds. The retained pixels of +finetune are those of its method without. At least two captures. An
 * exit status of cli.h. */
int stress_stability(stress_row *rows, const stress_case *c, const stress_contest *contest);

#endif
