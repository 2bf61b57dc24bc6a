/* Draws the arena as an SVG: stages across, bytes upwards, each buffer a block from its first to its last stage. */
#ifndef TRIM3R_TOOLS_PLAN_PICTURE_H
#define TRIM3R_TOOLS_PLAN_PICTURE_H

#include <stdio.h>

#include "trim3r.h"

/* Writes the picture, readable on light and dark backgrounds. Write errors stay in the stream (ferror). */
void plan_picture_write(FILE *file, const t3r_plan_info *plan);

#endif
