/* One map that follows a camera, of frames as they come: the arena, which frames are keyframes, the scene. */
#ifndef TRIM3R_TOOLS_KEYFRAME_MAP_H
#define TRIM3R_TOOLS_KEYFRAME_MAP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct keyframe_map_settings {
    uint32_t width, height;   /* the working size, T3R_MIN_SIDE..T3R_MAX_SIDE each [256] */
    uint32_t gaussians;       /* the most in the map, 1..T3R_MAX_GAUSSIANS [10000] */
    uint32_t at_hand;         /* keyframes that refinement works on, 1..T3R_MAX_VIEWS [4] */
    uint32_t every;           /* the n-th frame after a keyframe is the next one, at least 1 [3] */
    uint32_t overlap_percent; /* less in common with the last keyframe makes a frame one, 0..100; 0 = not asked [0] */
    uint32_t half_life;       /* as t3r_config has it [32] */
    uint32_t remember;        /* likewise [0] */
    uint32_t refine;          /* the passes of each keyframe [T3R_STREAM_REFINE] */
    uint32_t warm;            /* likewise [0] */
    uint32_t threads;         /* 1..T3R_MAX_WORKERS [1] */
    const char *head;         /* analytic, tiny, small or a file .t3w; read by the call that opens [small] */
} keyframe_map_settings;

keyframe_map_settings keyframe_map_defaults(void);

typedef struct keyframe_map keyframe_map;

/* Allocates the arena, which no later call does. NULL with the reason in error[] on failure. */
keyframe_map *keyframe_map_open(const keyframe_map_settings *settings, char *error, size_t error_bytes);
void keyframe_map_close(keyframe_map *map);
size_t keyframe_map_arena_bytes(const keyframe_map *map);

typedef struct keyframe_map_report {
    bool keyframe; /* the frame became one */
    uint64_t hash; /* of all stages so far: that which `trim3r replay --stream --every 1` tells of a keyframe */
    double milliseconds;
    t3r_stream_report taken; /* of a keyframe */
} keyframe_map_report;

/* The next frame, in the order of time. After an error the map is what t3r_stream_keyframe() leaves, and the next frame
 * is due. `report` is all 0 then. */
t3r_status keyframe_map_frame(keyframe_map *map, const t3r_frame *frame, const t3r_camera *camera,
                              keyframe_map_report *report);
/* T3R_ERR_STATE before the first keyframe. The scene is valid until the next frame. */
t3r_status keyframe_map_scene(const keyframe_map *map, t3r_scene *scene);
/* Writes the scene in the format of the path's suffix: 0, or -1 with the reason in error[]. */
int keyframe_map_save(const keyframe_map *map, const char *path, char *error, size_t error_bytes);

#ifdef __cplusplus
}
#endif
#endif
