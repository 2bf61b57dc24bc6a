/* SPDX-License-Identifier: Apache-2.0 */
/* Sources of poses, and their names in the option --poses. */
#ifndef TRIM3R_TOOLS_POSES_SOURCE_H
#define TRIM3R_TOOLS_POSES_SOURCE_H

#include <stdbool.h>

typedef enum poses_source {
    POSES_GIVEN,          /* they come with the frames */
    POSES_ESTIMATE,       /* estimated, with depth where two frames have it */
    POSES_ESTIMATE_COLOUR /* from colour alone; depth, where there is some, only sets the scale */
} poses_source;

#define POSES_NAMES "given, estimate, estimate-colour"
#define POSES_PLACEHOLDER "given|estimate|estimate-colour"
/* false: no such name. */
bool poses_named(const char *name, poses_source *source);
const char *poses_name(poses_source source);

#endif
