/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes by the rivals: the head's unpruned scene, pruned by a published score to an exact count, then left unchanged,
 * fine-tuned on the context views, or replaced by new Gaussians of trim3r's head at the same points. In floats on the
 * host: the promise of identical bits does not apply. */
#ifndef TRIM3R_TOOLS_RIVALS_RIVAL_H
#define TRIM3R_TOOLS_RIVALS_RIVAL_H

#include "reconstruction/reconstruction.h"
#include "study/rivals/methods.h"

/* The `build` of every method except trim3r, in an arena that only renders, or with +head in the arena of its build.
 * In *account the arena is the runtime's largest; the time is the total, including the unpruned scene, scoring and
 * fine-tuning. A scene from a file cannot be traced to points for a rival's +head: there the points are its
 * Gaussians, and the head is "". */
int rival_build(method_source *source, const t3r_recording *recording, const char *path,
                const reconstruction_options *options, reconstruction *made, reconstruction_account *account);

#endif
