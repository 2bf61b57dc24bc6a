/* Scenes on disk: 3DGS .ply, binary little-endian. Read and written in double; SPEC's fixed point begins behind. */
#ifndef TRIM3R_TOOLS_SCENE_FILE_H
#define TRIM3R_TOOLS_SCENE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

/* Whether a path ends as scene files do. */
bool path_is_ply(const char *path);

/* A scene outside any arena. */
typedef struct scene_file {
    t3r_scene_frame frame;
    t3r_gaussian *gaussians; /* heap; scene_file_free() */
    uint32_t count;
} scene_file;

/* Reads a .ply (degree 0 of its harmonics): 0, or -1 with "what, where" in error[]. NaN, infinities (but those of an
 * opacity of 0 or 1 and of a scale of 0), cut files, missing properties and foreign formats are refused with a reason.
 * The scene frame (origin, exponent) is the one that SCENE_FILE_COMMENTS named, else chosen from the positions. */
int scene_file_read_ply(const char *path, scene_file *out, char *error, size_t error_bytes);
int scene_file_parse_ply(const uint8_t *bytes, size_t count, scene_file *out, char *error, size_t error_bytes);
/* Writes in the recording's world frame; flags: 0, or of these. `note` (NULL: none), one line, becomes another comment.
 */
enum {
    SCENE_FILE_LOCAL = 1,    /* without the frame's origin: metres from the first context camera, say */
    SCENE_FILE_COMMENTS = 2, /* header comments that name bits epoch and scene frame; some readers choke on comments */
};
int scene_file_write_ply(const char *path, const t3r_scene *scene, int flags, const char *note, char *error,
                         size_t error_bytes);
void scene_file_free(scene_file *scene);

#endif
