/* SPDX-License-Identifier: Apache-2.0 */
/* Turns bytes into a build, a slide of consecutive builds, or a stream, which the runtime accepts: settings, frames,
 * cameras, weights and requests. The same bytes give the same case. Each number has a fixed place, so that changing a
 * byte changes one number and no others. */
#ifndef T3R_FUZZ_DRAWN_CASE_H
#define T3R_FUZZ_DRAWN_CASE_H

#include "arguments.h"
#include "state/ablation.h"

enum { MOST_FRAMES = 5, MOST_WORLD_SHIFT = 4 };

typedef enum story {
    ONE_BUILD, /* of all frames, and possibly another one of the same analysis */
    SLIDE,     /* a build, and one more after each further frame */
    STREAM,    /* a keyframe for each frame */
    STORIES
} story;

/* A wall with a step in it, painted with noise. */
typedef struct scenery {
    uint32_t cell;       /* side of a paint spot in pixels */
    uint32_t contrast;   /* of the spots, 0..255 */
    uint32_t distance;   /* of the wall, in steps of depth */
    uint32_t relief;     /* of the step in the wall */
    uint32_t noise;      /* of the sensor, in steps of depth */
    uint32_t lost;       /* one in `lost` pixels has no depth; 0 = all have depth */
    uint32_t hole;       /* side of the holes in the middle in pixels */
    uint32_t black;      /* empty rows at the top: no colour, no depth */
    uint32_t colours[3]; /* mean levels */
    uint32_t seed;
} scenery;

typedef struct drawn_case {
    story tells;
    t3r_config config;
    t3r_ablation ablation;
    scenery shows;
    uint32_t frames; /* a build has one per view, the others have more */
    t3r_frame frame; /* common fields: without planes, without bytes between rows */
    t3r_camera camera[MOST_FRAMES];
    uint32_t gain_q7[MOST_FRAMES]; /* exposure */
    t3r_request first, again;      /* again.gaussians = 0: no second build */
    uint16_t *importance;
    const uint16_t *planes[T3R_MAX_VIEWS]; /* of the importance */
    t3r_camera eye;
    uint32_t eye_width, eye_height;
    uint8_t *weights;
    size_t weights_bytes;
} drawn_case;

/* Makes a case; free it with free_case(), as its requests point into it. */
void draw_case(input *in, drawn_case *c);
void free_case(drawn_case *c);

/* Returns a frame with `padding` bytes between its rows; free it with free_frame(). */
held_frame frame_of(const drawn_case *c, uint32_t index, uint32_t padding);

#endif
