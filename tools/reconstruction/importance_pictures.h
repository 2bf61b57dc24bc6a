/* SPDX-License-Identifier: Apache-2.0 */
/* Reads the importance of the points of the context views (allocation `given`) from grey pictures. */
#ifndef TRIM3R_TOOLS_IMPORTANCE_PICTURES_H
#define TRIM3R_TOOLS_IMPORTANCE_PICTURES_H

#include <stdint.h>

#include "trim3r.h"

typedef struct importance_pictures {
    uint16_t *planes[T3R_MAX_VIEWS]; /* width x height each, 65535 = most important; NULL beyond the context views */
} importance_pictures;

/* Reads the pictures. `text` names a picture per context view, separated by commas, in the order of the views, or a
 * folder with <frame>.png for each of the frames `context`. They are grey, width x height: 16 bits are used unchanged;
 * levels of 8 bits are multiplied by 256, and ties broken by blue noise. Returns an exit status of cli.h after a
 * message; call importance_pictures_free() in either case. */
int importance_pictures_read(importance_pictures *pictures, const char *text, const uint32_t *context, uint32_t count,
                             uint32_t width, uint32_t height);
void importance_pictures_free(importance_pictures *pictures);

#endif
