/* SPDX-License-Identifier: Apache-2.0 */
/* Leaves out the frames of a folder that cannot be used, so that the rest can be imported. */
#ifndef TRIM3R_TOOLS_REJECTED_H
#define TRIM3R_TOOLS_REJECTED_H

#include <stddef.h>

#include "import/frames/posed_frame.h"

/* Marks a frame that cannot be used, with the reason, which names the frame; the first reason stays. */
void rejected_mark(posed_frame *frame, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Drops the marked frames and their triplets, and notes each in folder->left_out. Returns 0, or -1 with the first
 * reason in error[] if no frame stays. */
int rejected_drop(posed_folder *folder, char *error, size_t error_bytes);

/* Makes every frame once, as import does in that size. Drops the frames that cannot be made, and depth that cannot be
 * used, with a note of each. Returns 0, or -1 with "picture: why" in error[] if no frame, or none of the depth, can be
 * made. */
int rejected_find(const char *directory, posed_folder *folder, uint32_t width, uint32_t height, char *error,
                  size_t error_bytes);

#endif
