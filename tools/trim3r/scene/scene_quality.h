/* SPDX-License-Identifier: Apache-2.0 */
/* Whether a scene shows its pictures well, in a word. */
#ifndef TRIM3R_TOOLS_SCENE_QUALITY_H
#define TRIM3R_TOOLS_SCENE_QUALITY_H

#include "trim3r/scene/drawn_pictures.h"

#define SCENE_GOOD_DB 25.0 /* from here on a drawn picture is good */
#define SCENE_POOR_DB 18.0 /* below, it is poor */

/* good: the median of the chosen pictures is good and none of them poor, nor the median of the others, if there are
 * any. poor: more than a quarter of the chosen pictures is poor. fair: else. */
typedef enum scene_quality { SCENE_POOR, SCENE_FAIR, SCENE_GOOD } scene_quality;

/* Judges 1..DRAWN_MOST pictures, of which one at least is chosen. */
scene_quality scene_quality_of(const drawn_picture *pictures, uint32_t count);
/* Returns "poor", "fair" or "good". */
const char *scene_quality_name(scene_quality quality);

#endif
