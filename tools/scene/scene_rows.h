/* Gaussians as the readers of scene files have them, in double, to a scene in the runtime's fixed point. */
#ifndef TRIM3R_TOOLS_SCENE_ROWS_H
#define TRIM3R_TOOLS_SCENE_ROWS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "scene/scene_file.h"

#define SCENE_HARMONIC_0 0.28209479177387814 /* colour = 0.5 + SCENE_HARMONIC_0 x the harmonic of degree 0 */

/* A Gaussian as 3DGS stores it. All is finite, but that the logit may be either infinity and a log_scale the negative
 * one. */
typedef struct scene_row {
    double position[3];
    double harmonic[3]; /* of degree 0: red, green, blue */
    double opacity_logit;
    double log_scale[3]; /* natural */
    double rotation[4];  /* w, x, y, z; of any length */
} scene_row;

typedef struct scene_rows {
    uint32_t count; /* at least 1 */
    bool has_frame; /* the file names its frame; else one is chosen from the positions */
    bool local;     /* positions are from the named frame's origin */
    t3r_scene_frame frame;
    /* Row `index`: 0, or -1 with the reason in error[]. It may be asked for any number of times. */
    int (*read)(void *user, uint32_t index, scene_row *row, char *error, size_t error_bytes);
    void *user;
} scene_rows;

/* 0, and scene_file_free() is due; or -1 with the reason in error[]. */
int scene_file_from_rows(const scene_rows *rows, scene_file *out, char *error, size_t error_bytes);

#endif
