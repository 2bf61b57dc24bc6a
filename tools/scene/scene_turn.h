/* SPDX-License-Identifier: Apache-2.0 */
/* Turns between the axes of files and of a scene. A scene in memory has the axes of its recording, or of a .ply: for
 * formats with axes of their own, x points right in it, y down and z forward. */
#ifndef TRIM3R_TOOLS_SCENE_TURN_H
#define TRIM3R_TOOLS_SCENE_TURN_H

#include <stdbool.h>
#include <stdint.h>

#include "scene/harmonics.h"
#include "trim3r_host.h"

/* The axes of a file: where x, y and z point, of left or right, up or down, forward or backward. Numbers and meaning
 * are those of nianticlabs/spz, whose files can declare any of them; half of them mirror a scene. From SCENE_AXES_LFD
 * on that library turns the axes with the number 8 less by a quarter about x, which is not what its names say. */
typedef enum scene_axes {
    SCENE_AXES_AS_THEY_ARE, /* the scene's axes, unchanged */
    SCENE_AXES_LDB,
    SCENE_AXES_RUB = 4, /* x right, y up, z backward */
    SCENE_AXES_RDF = 6, /* x right, y down, z forward: as scenes */
    SCENE_AXES_LUF = 7, /* x left, y up, z forward */
    SCENE_AXES_LFD = 9,
    SCENE_AXES_RBU = 16,
    SCENE_AXES_LAST = SCENE_AXES_RBU
} scene_axes;

/* The type of trim3r_host.h, by the name that the tools use. */
typedef t3r_scene_up scene_up;
#define SCENE_UP_NAMES "x, -x, y, -y, z, -z"

typedef struct scene_turn {
    bool none;          /* identity: need not be applied */
    bool mirrors;       /* the rotation is followed by x, y, z -> -x, -y, -z */
    double rotation[4]; /* unit quaternion, w x y z */
    double matrix[9];   /* of positions, row-major; between axes the entries are -1, 0 and 1 */
    harmonics_turn harmonics;
} scene_turn;

/* Returns the turn from a file with the axes `from` to one with `to`. If `up` is known, it is an axis of the scene, and
 * y points up in the second file, whatever its format. */
scene_turn scene_turn_between(scene_axes from, scene_axes to, scene_up up);
/* Returns the turn by a unit quaternion w x y z. */
scene_turn scene_turn_of(const double rotation[4]);
/* Turns a Gaussian with harmonics up to a degree of 0..3. */
void scene_turn_apply(const scene_turn *turn, double position[3], double rotation[4], uint32_t degree,
                      double rest[HARMONICS_REST_MOST][3]);
/* Turns the origin of a scene's frame. */
void scene_turn_origin(const scene_turn *turn, const int64_t origin_q32[3], int64_t turned_q32[3]);
/* Returns the axis of a name from SCENE_UP_NAMES; T3R_UP_UNKNOWN: there is none. */
scene_up scene_up_named(const char *name);
/* Returns the name of an axis. */
const char *scene_up_name(scene_up up);

#endif
