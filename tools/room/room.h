/* The built-in recording: a furnished room, ray-cast in integers, with exact depth and poses. The same source gives the
 * same bits with every compiler and on every processor; it reads nothing and keeps no state.
 *
 * 4 x 3 x 5 metres seen through a 60 degree lens from an arc around its centre; world axes x right, y down, z into the
 * room; lengths in metres; depth in millimetres. */
#ifndef TRIM3R_TOOLS_ROOM_H
#define TRIM3R_TOOLS_ROOM_H

#include <stdint.h>

#include "recording/recording.h"
#include "trim3r.h"

#define ROOM_SIDE 256u /* default width and height */
#define ROOM_FRAMES 6u /* default number of frames */
#define ROOM_MAX_FRAMES 1000u
#define ROOM_MAX_TRIPLETS 3u
#define ROOM_DEPTH_UNIT_Q40 UINT64_C(1099511628) /* 1 mm, as in t3r_frame */

/* Computes the camera of frame `index` (any; the path goes back and forth and repeats after 70) for width x height
 * pixels (8..T3R_MAX_SIDE). */
void room_camera(uint32_t index, uint32_t width, uint32_t height, t3r_camera *camera);
/* Computes the same numbers as doubles, exactly. */
void room_recorded_camera(uint32_t index, uint32_t width, uint32_t height, t3r_recorded_camera *camera);

/* Draws frame `index`: rgb has 3 width height bytes, depth_mm width height steps (NULL = not wanted), rows without
 * gaps. Colour has mild sensor noise; depth has none and is valid everywhere. The seed changes textures and noise. */
void room_frame(uint32_t index, uint32_t width, uint32_t height, uint32_t seed, uint8_t *rgb, uint16_t *depth_mm);

/* Chooses context and target frames among the first `frames` frames; returns the number of triplets. */
uint32_t room_triplets(uint32_t frames, t3r_triplet triplets[ROOM_MAX_TRIPLETS]);

#endif
