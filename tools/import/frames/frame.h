/* SPDX-License-Identifier: Apache-2.0 */
/* One frame of a posed folder as the recording holds it: decoded, cropped, resized, its camera adapted. */
#ifndef TRIM3R_TOOLS_IMPORT_FRAME_H
#define TRIM3R_TOOLS_IMPORT_FRAME_H

#include <stddef.h>
#include <stdint.h>

#include "import/frames/posed_frame.h"
#include "pictures/picture.h"
#include "recording/recording.h"

/* Reads the sides of the frame's picture, upright, from its header. Returns 0, or -1 with "picture: what" in error[].
 */
int import_picture_size(const char *directory, const posed_frame *frame, uint32_t *width, uint32_t *height, char *error,
                        size_t error_bytes);

/* Reads the same, and the focal length that EXIF states in terms of 35 mm film; 0: none. */
int import_picture_facts(const char *directory, const posed_frame *frame, uint32_t *width, uint32_t *height,
                         double *focal_35mm, char *error, size_t error_bytes);

/* Reads the whole picture, as its camera sees it. Returns 0, or -1 with "picture: what" in error[]; call picture_free()
 * in either case. */
int import_picture_upright(const char *directory, const posed_frame *frame, picture *out, char *error,
                           size_t error_bytes);

/* Reads the sides of its depth; the frame must have depth. */
int import_depth_size(const char *directory, const posed_frame *frame, uint32_t *width, uint32_t *height, char *error,
                      size_t error_bytes);

typedef struct import_buffers {
    uint8_t *rgb;
    uint16_t *depth;
} import_buffers;

/* Reads and adapts a frame: to width x height, or unchanged in size when width is 0. depth: 16-bit steps made
 * elsewhere, which replace the frame's own (NULL: those are used) and which the call consumes. `out` (all but its
 * stamp) points into `buffers`, which import_buffers_free() releases in either case. Returns 0; with "picture: what" in
 * error[], IMPORT_NO_FRAME if its picture or camera cannot be used, IMPORT_NO_DEPTH if its depth cannot, and -1 if
 * memory is out. */
enum { IMPORT_NO_FRAME = 1, IMPORT_NO_DEPTH };
int import_frame(const char *directory, const posed_frame *frame, picture *depth, uint32_t width, uint32_t height,
                 import_buffers *buffers, t3r_recorded_frame *out, char *error, size_t error_bytes);
void import_buffers_free(import_buffers *buffers);

#endif
