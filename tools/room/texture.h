/* The room's surfaces: colours from integer value noise. Lengths Q16 metres, colours Q4 (0..4080). */
#ifndef TRIM3R_TOOLS_ROOM_TEXTURE_H
#define TRIM3R_TOOLS_ROOM_TEXTURE_H

#include <stdint.h>

#include "room/scene.h"

typedef struct room_colour {
    int32_t c[3];
} room_colour;

/* Returns the surface's own colour at a hit. footprint: the side of the patch that one sample covers; finer detail
 * fades into its mean. */
room_colour room_texture(const room_hit *hit, uint32_t seed, int64_t footprint);

#endif
