/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes on disk, read and written in double; SPEC's fixed point begins after reading. */
#ifndef TRIM3R_TOOLS_SCENE_FILE_H
#define TRIM3R_TOOLS_SCENE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r_host.h"

#define SCENE_FILE_SUFFIXES_BYTES 96

/* The types of trim3r_host.h, by the names that the tools use. */
typedef t3r_scene_remarks scene_remarks;
typedef t3r_scene_file scene_file;

/* Returns the numbers in harmonics_q12 per Gaussian. */
static inline size_t scene_file_harmonics_count(const scene_file *scene)
{
    return 3 * (size_t)(scene->degree + 1) * (scene->degree + 1);
}

/* Returns the harmonics of one Gaussian; the degree must be above 0. */
static inline int16_t *scene_file_harmonics(const scene_file *scene, uint32_t index)
{
    return scene->harmonics_q12 + index * scene_file_harmonics_count(scene);
}

/* Returns how many of the Gaussians are of surfaces. Rim and backdrop follow them. */
static inline uint32_t scene_surfaces(const t3r_gaussian *gaussians, uint32_t count)
{
    while (count > 0 && gaussians[count - 1].view == T3R_NO_VIEW) {
        count--;
    }
    return count;
}

/* Whether a file is a scene by its content; or by its suffix, if it does not exist or its content is no other kind. */
bool scene_file_is_one(const char *path);
/* Whether a path has the suffix of a scene file that can be written. */
bool scene_file_is_written(const char *path);
/* Writes the suffixes of files that can be written: ".ply, .splat". */
const char *scene_file_suffixes(char text[SCENE_FILE_SUFFIXES_BYTES]);

/* Flags besides those of trim3r_host.h. */
enum {
    SCENE_FILE_QUIET = 8, /* for reading: no warnings, because the file was read before */
    SCENE_FILE_UP = 16,   /* for writing: multiplied by a scene_up of scene_turn.h, turns this axis to y, pointing up */
};

/* Reads a scene in the format that its first bytes identify, else its suffix. flags: a sum of T3R_SCENE_DROP_INVALID
 * and SCENE_FILE_QUIET. Prints a warning for each of the remarks. Returns 0, or -1 with "what, where" in error[]. The
 * scene frame (origin, exponent) is the one in the file's T3R_SCENE_COMMENTS, else chosen from the positions. */
int scene_file_read(const char *path, int flags, scene_file *out, char *error, size_t error_bytes);
/* The same for bytes in memory, without the warnings; `name` ends with the suffix. */
int scene_file_parse(const char *name, const uint8_t *bytes, size_t count, int flags, scene_file *out, char *error,
                     size_t error_bytes);

/* Writes in the recording's world frame, in the format of the path's suffix; flags: a sum of T3R_SCENE_LOCAL,
 * T3R_SCENE_COMMENTS and SCENE_FILE_UP. `note` (NULL: none), one line, becomes another comment. Floats lose the detail
 * of a scene that is small and far from the world's origin: it is written as by T3R_SCENE_LOCAL, with the origin in the
 * file if the format has a place for it, and a warning. Refused are scenes that could not be read again: empty ones,
 * fields out of range, an extent outside 2^-24..2^24 units. Returns 0, or -1 with the reason in error[]. */
int scene_file_write(const char *path, const t3r_scene *scene, int flags, const char *note, char *error,
                     size_t error_bytes);

/* The part of a scene that is kept: Gaussians with their means in a box of the world, both ends in it, and with an
 * opacity (0..1) of at least `opacity`. */
typedef struct scene_crop {
    double low[3], high[3], opacity;
} scene_crop;

/* A file in another format, in doubles from end to end: what both formats hold stays as it is. */
typedef struct scene_conversion {
    uint32_t count_read, count;   /* Gaussians */
    uint32_t degree_read, degree; /* of harmonics */
} scene_conversion;
/* `flags` of both reading and writing; crop: NULL keeps all. Returns 0, or -1 with the reason in error[]. */
int scene_file_convert(const char *from, const char *to, int flags, const scene_crop *crop, scene_conversion *out,
                       char *error, size_t error_bytes);
void scene_file_free(scene_file *scene);

#endif
