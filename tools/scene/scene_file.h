/* Scenes on disk. Read and written in double; SPEC's fixed point begins behind. */
#ifndef TRIM3R_TOOLS_SCENE_FILE_H
#define TRIM3R_TOOLS_SCENE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

#define SCENE_FILE_SUFFIXES_BYTES 96

/* A scene outside any arena. */
typedef struct scene_file {
    t3r_scene_frame frame;
    t3r_gaussian *gaussians; /* heap; scene_file_free() */
    uint32_t count;
    uint32_t degree;        /* of the harmonics of its colours, 0..3 */
    int16_t *harmonics_q12; /* heap; NULL: degree 0. As t3r_harmonics_colour() takes them, a Gaussian after the other */
} scene_file;

/* Numbers of harmonics_q12 a Gaussian. */
static inline size_t scene_file_harmonics_count(const scene_file *scene)
{
    return 3 * (size_t)(scene->degree + 1) * (scene->degree + 1);
}

/* Those of one Gaussian; degree above 0. */
static inline int16_t *scene_file_harmonics(const scene_file *scene, uint32_t index)
{
    return scene->harmonics_q12 + index * scene_file_harmonics_count(scene);
}

/* Whether a path ends as scene files do: those that are read, or written. */
bool scene_file_is_read(const char *path);
bool scene_file_is_written(const char *path);
/* ".ply, .splat": how files end that are written. */
const char *scene_file_suffixes(char text[SCENE_FILE_SUFFIXES_BYTES]);

/* Reads a scene of the format that its first bytes name, else its suffix: 0, or -1 with "what, where" in error[]. The
 * scene frame (origin, exponent) is the one that SCENE_FILE_COMMENTS named, else chosen from the positions. */
int scene_file_read(const char *path, scene_file *out, char *error, size_t error_bytes);
/* The same of bytes in memory; `name` ends with the suffix. */
int scene_file_parse(const char *name, const uint8_t *bytes, size_t count, scene_file *out, char *error,
                     size_t error_bytes);

/* Writes in the recording's world frame, in the format of the path's suffix; flags: 0, or of these. `note` (NULL:
 * none), one line, becomes another comment. 0, or -1 with the reason in error[]. */
enum {
    SCENE_FILE_LOCAL = 1,    /* without the frame's origin: metres from the first context camera, say */
    SCENE_FILE_COMMENTS = 2, /* header comments that name bits epoch and scene frame; some readers choke on comments */
    SCENE_FILE_UP = 16,      /* times a scene_up of scene_turn.h: this axis becomes y, and y points up */
};
int scene_file_write(const char *path, const t3r_scene *scene, int flags, const char *note, char *error,
                     size_t error_bytes);
/* The same of a scene from a file, with harmonics up to the degree that the format holds. */
int scene_file_rewrite(const char *path, const scene_file *scene, int flags, char *error, size_t error_bytes);
/* The degree of harmonics that files of the path's suffix hold, 0..3. */
uint32_t scene_file_degree_most(const char *path);
void scene_file_free(scene_file *scene);

#endif
