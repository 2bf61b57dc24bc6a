/* SPDX-License-Identifier: Apache-2.0 */
/* Frames and depth that an import leaves out: they are counted and named; --strict refuses them. For folders and bags.
 */
#ifndef TRIM3R_TOOLS_LEFT_OUT_H
#define TRIM3R_TOOLS_LEFT_OUT_H

#include <stddef.h>

#include "cli/text/text_list.h"

/* Initialise with zeros. Lines are "what: why". */
typedef struct left_out {
    text_list frames; /* pictures or messages that give no frame */
    text_list depth;  /* depth of frames that keep their colour */
} left_out;

#define LEFT_OUT_STRICT_HELP                                                                                           \
    "refuse the import if a frame or the depth of a frame cannot be used (it is left out, counted and named)"

/* Refuses the import by --strict: returns -1 with the counts and the first reason in error[]; 0 if nothing is left
 * out. */
int left_out_refuse(const left_out *what, char *error, size_t error_bytes);
/* Prints a line for each. */
void left_out_print(const left_out *what);
/* Adds "skipped", the number of frames, and the lists "left_out" and "depth_left_out". */
void left_out_add_json(const left_out *what, cJSON *object);
void left_out_free(left_out *what);

#endif
