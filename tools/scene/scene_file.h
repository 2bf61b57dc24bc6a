/* Scenes on disk. Read and written in double; SPEC's fixed point begins behind. */
#ifndef TRIM3R_TOOLS_SCENE_FILE_H
#define TRIM3R_TOOLS_SCENE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

#define SCENE_FILE_SUFFIXES_BYTES 64

/* A scene outside any arena. */
typedef struct scene_file {
    t3r_scene_frame frame;
    t3r_gaussian *gaussians; /* heap; scene_file_free() */
    uint32_t count;
} scene_file;

/* Whether a path ends as scene files do: those that are read, or written. */
bool scene_file_is_read(const char *path);
bool scene_file_is_written(const char *path);
/* ".ply, .splat": how files end that are written. */
const char *scene_file_suffixes(char text[SCENE_FILE_SUFFIXES_BYTES]);

/* Reads a scene of the format that its first bytes name, else its suffix: 0, or -1 with "what, where" in error[]. The
 * scene frame (origin, exponent) is the one that SCENE_FILE_COMMENTS named, else chosen from the positions. */
int scene_file_read(const char *path, scene_file *out, char *error, size_t error_bytes);
int scene_file_parse(const uint8_t *bytes, size_t count, scene_file *out, char *error, size_t error_bytes);

/* Writes in the recording's world frame, in the format of the path's suffix; flags: 0, or of these. `note` (NULL:
 * none), one line, becomes another comment. 0, or -1 with the reason in error[]. */
enum {
    SCENE_FILE_LOCAL = 1,    /* without the frame's origin: metres from the first context camera, say */
    SCENE_FILE_COMMENTS = 2, /* header comments that name bits epoch and scene frame; some readers choke on comments */
};
int scene_file_write(const char *path, const t3r_scene *scene, int flags, const char *note, char *error,
                     size_t error_bytes);
void scene_file_free(scene_file *scene);

#endif
