/* A camera's position and orientation, without its lens. */
#ifndef T3R_PLACEMENT_H
#define T3R_PLACEMENT_H

#include "memory.h"
#include "trim3r.h"

/* The pose of a t3r_camera, in the same formats. */
typedef struct t3r_placement {
    int64_t position_q32[3];
    int32_t rotation_q30[4];
} t3r_placement;

static inline void t3r_note_placement(t3r_placement *placement, const t3r_camera *camera)
{
    memcpy(placement->position_q32, camera->position_q32, sizeof placement->position_q32);
    memcpy(placement->rotation_q30, camera->rotation_q30, sizeof placement->rotation_q30);
}

static inline void t3r_place_camera(t3r_camera *camera, const t3r_placement *placement)
{
    memcpy(camera->position_q32, placement->position_q32, sizeof placement->position_q32);
    memcpy(camera->rotation_q30, placement->rotation_q30, sizeof placement->rotation_q30);
}

#endif
