/* SPDX-License-Identifier: Apache-2.0 */
/* Converts Gaussians in double, as scene files have them, to a scene in the runtime's fixed point, and back. */
#ifndef TRIM3R_TOOLS_SCENE_ROWS_H
#define TRIM3R_TOOLS_SCENE_ROWS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "scene/harmonics.h"
#include "scene/scene_file.h"
#include "scene/scene_turn.h"

/* A Gaussian as 3DGS stores it. All numbers are finite, except that the logit may be either infinity and a log_scale
 * the negative one. */
typedef struct scene_row {
    double position[3];
    double harmonic[3]; /* of degree 0: red, green, blue */
    double rest[HARMONICS_REST_MOST][3];
    double opacity_logit;
    double log_scale[3]; /* natural logarithm */
    double rotation[4];  /* w, x, y, z; of any length */
} scene_row;

typedef struct scene_bounds {
    double least, most;
} scene_bounds;

/* The Gaussians of a file or of a scene in memory, in the axes and the precision that they have there. */
typedef struct scene_rows {
    uint32_t count; /* at least 1 */
    bool has_frame; /* the file has a frame; else one is chosen from the positions */
    bool local;     /* positions are relative to the given frame's origin */
    t3r_scene_frame frame;
    uint32_t degree;    /* of the rows' harmonics, 0..3 */
    scene_axes axes;    /* of the file */
    scene_up up;        /* as a comment of the file names it */
    bool mip;           /* opacities are those of mip-splatting (SPZ's "antialiased") */
    uint32_t backdrop;  /* the last so many rows are rim and backdrop, without a depth; at most count */
    const char *remark; /* what of the file is not read; NULL: nothing */
    /* Reads row `index`, any number of times. Returns 0, or -1 with the reason in error[]. */
    int (*read)(void *user, uint32_t index, scene_row *row, char *error, size_t error_bytes);
    void *user;
} scene_rows;

#define SCENE_REMARK_DEGREE_4 "harmonics of degree 4 are left out"

/* Reads a row and checks it: its position is within SCENE_POSITION_MOST, its rotation has a length. */
int scene_rows_read(const scene_rows *rows, uint32_t index, scene_row *row, char *error, size_t error_bytes);
#define SCENE_POSITION_MOST 0x1p1000

/* Takes the rows of a file, which live until it returns. Returns 0, or -1 with the reason in error[]. */
typedef struct scene_sink {
    int (*take)(void *user, const scene_rows *rows, char *error, size_t error_bytes);
    void *user;
} scene_sink;

/* Hands the rows of a file to a sink; flags: as for scene_file_read(). Prints a warning of what is not read. Returns 0,
 * or -1 with the reason in error[]; the sink's reasons have to name their file. */
int scene_file_take(const char *path, int flags, const scene_sink *sink, char *error, size_t error_bytes);

/* ---- the runtime's fixed point ---- */

struct scene_extent;
/* Chooses a frame for rows of a file without one, as they are turned: origin at the centre, typical distance in [1, 2)
 * scene units. *extent receives that of the rows. Returns 0, or -1 with the reason in error[] if no frame is in range.
 */
int scene_rows_choose_frame(const scene_rows *rows, const scene_turn *turn, t3r_scene_frame *frame,
                            struct scene_extent *extent, char *error, size_t error_bytes);
/* Returns 0, after which scene_file_free() is due; or -1 with the reason in error[]. */
int scene_file_from_rows(const scene_rows *rows, scene_file *out, char *error, size_t error_bytes);
/* Returns the rows of a scene in fixed point, which has to outlive them. */
scene_rows scene_rows_of(const scene_file *scene);

/* ---- writing ---- */

/* The rows of a scene in the axes of a file, relative to an origin. Rotations have unit length. */
typedef struct scene_source {
    const scene_rows *rows;
    int flags; /* as for scene_file_write() */
    const char *note;
    t3r_scene_frame frame; /* in the axes of the rows; written where the format has a place for it */
    scene_turn turn;       /* from the axes of the rows to those of the file */
    double shift[3];       /* added to the positions of the rows */
    double centre[3];      /* of the scene (scene_extent), in the axes and the frame of the file */
    double typical;        /* distance from there, as in scene_extent */
    uint32_t degree;       /* of the harmonics to write */
} scene_source;

void scene_source_row(const scene_source *source, uint32_t index, scene_row *row);
/* Returns the opacity of a row, 0..1. */
double scene_row_opacity(const scene_row *row);
/* Returns the colour of degree 0, 0..1 if a screen can show it; `channel` 0..2. */
double scene_row_colour(const scene_row *row, int channel);

#endif
