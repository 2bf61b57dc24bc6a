/* SPDX-License-Identifier: Apache-2.0 */
/* Gives the answers of an instance of the module, which reads or writes one file. */
#ifndef TRIM3R_TOOLS_VIEWER_ANSWER_H
#define TRIM3R_TOOLS_VIEWER_ANSWER_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

#define EXPORT(name) __attribute__((export_name(#name)))
#define IMPORT(name) __attribute__((import_module("page"), import_name(#name)))

typedef struct page_answer {
    char text[1024]; /* remarks, or the reason of a failure */
    size_t length;
    char *bytes; /* the bundle of a file that was read, or the file that was written */
    size_t count;
    uint32_t gaussians; /* of a scene, or the first budget of a recording */
} page_answer;

extern page_answer answer;

/* Adds a remark to the text. */
void answer_remark(const char *text);
/* Returns a number of a camera: focal lengths and centre in pixels, position, rotation w x y z, width and height in
 * pixels. */
double answer_camera(const t3r_camera *camera, uint32_t index);

#endif
