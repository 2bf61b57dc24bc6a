/* SPDX-License-Identifier: Apache-2.0 */
/* A map that follows a camera from arriving frames: the arena, the choice of keyframes, the scene. */
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
    uint32_t width, height; /* the working size, T3R_MIN_SIDE..T3R_MAX_SIDE each [256] */
    uint32_t gaussians;     /* the most in the map, 1..T3R_MAX_GAUSSIANS [10000] */
    uint32_t at_hand;       /* live keyframes that refinement works on, 1..T3R_MAX_VIEWS [4] */
    uint32_t every;         /* the n-th frame after a keyframe is the next keyframe, at least 1 [3] */
    uint32_t
        overlap_percent; /* a frame with less overlap with the last keyframe becomes one, 0..100; 0 = not checked [0] */
    uint32_t half_life;  /* as in t3r_config [32] */
    uint32_t remember;   /* likewise [0] */
    uint32_t refine;     /* the passes of each keyframe [T3R_STREAM_REFINE] */
    uint32_t warm;       /* likewise [0] */
    uint32_t gate;       /* likewise: 0 takes frames that cannot be trusted, too [1] */
    uint32_t threads;    /* 1..T3R_MAX_WORKERS [1] */
    double max_ms;       /* milliseconds that a keyframe may take; bits then differ from run to run; 0 = no limit [0] */
    uint32_t snapshot;   /* keyframes between two writes of scene and state; 0 = only by keyframe_map_save() [0] */
    bool resume;         /* continue from `state`, if it exists [false] */
    const char *head;    /* analytic, tiny, small or a file .t3w; read by the call that opens [small] */
    const char *scene;   /* file of the map; NULL = none [NULL] */
    const char *state;   /* file of the whole stream, from which another run continues; NULL = none [NULL] */
    const char *lines;   /* file of a JSON object for each frame offered as a keyframe; NULL = none [NULL] */
} keyframe_map_settings;

keyframe_map_settings keyframe_map_defaults(void);

typedef struct keyframe_map keyframe_map;

/* Allocates the arena; no later call allocates but to write files. Returns NULL with the reason in error[] on failure.
 */
keyframe_map *keyframe_map_open(const keyframe_map_settings *settings, char *error, size_t error_bytes);
void keyframe_map_close(keyframe_map *map);
size_t keyframe_map_arena_bytes(const keyframe_map *map);

typedef struct keyframe_map_report {
    bool keyframe; /* the frame became a keyframe */
    uint64_t hash; /* of all stages so far: what `trim3r replay --stream --every 1` reports for a keyframe */
    double milliseconds;
    t3r_stream_report taken; /* of a frame that was due: a keyframe, or the reason why it was refused */
} keyframe_map_report;

/* Adds the next frame in time, and writes the files that are due; a reason why they cannot be written is in error[],
 * else "". After an error the map is as t3r_stream_keyframe() leaves it, the next frame is due, and `report` is all
 * 0. */
t3r_status keyframe_map_frame(keyframe_map *map, int64_t stamp_ns, const t3r_frame *frame, const t3r_camera *camera,
                              keyframe_map_report *report, char *error, size_t error_bytes);
/* Returns T3R_ERR_STATE before the first keyframe. The scene is valid until the next frame. */
t3r_status keyframe_map_scene(const keyframe_map *map, t3r_scene *scene);
/* Writes scene and state. Returns 0, or -1 with the reason in error[]. */
int keyframe_map_save(keyframe_map *map, char *error, size_t error_bytes);

#ifdef __cplusplus
}
#endif
#endif
