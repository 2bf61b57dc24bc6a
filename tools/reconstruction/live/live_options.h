/* SPDX-License-Identifier: Apache-2.0 */
/* The options of a map that follows a camera, which replay and capture share. */
#ifndef TRIM3R_TOOLS_LIVE_OPTIONS_H
#define TRIM3R_TOOLS_LIVE_OPTIONS_H

#include <argp.h>
#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

#define LIVE_EVERY 3u
#define LIVE_AT_HAND 4u
#define LIVE_GAUSSIANS 10000u /* without a recording */
#define LIVE_STDOUT "-"       /* as the file of lines */

typedef struct live_options {
    uint32_t every;      /* interval between keyframes in frames; 0 = LIVE_EVERY */
    uint32_t overlap_q8; /* if not 0: a frame is also a keyframe when its overlap with the last keyframe is less */
    uint32_t at_hand;    /* live keyframes, whose planes are kept; 0 = LIVE_AT_HAND */
    double most_ms;      /* milliseconds that a keyframe may take, as refinement can shorten it; 0 = no limit */
    const char *scene;   /* the file of the map; NULL = none */
    uint32_t snapshot;   /* keyframes between two writes of the map and of the state; 0 = only in the end */
    const char *state;   /* the file of the whole stream, from which another run continues; NULL = none */
    bool resume;         /* continue from `state`, if it exists */
    const char *lines;   /* the file of JSON lines, "-" = standard output; NULL = none */
} live_options;

/* An argp child; each parent's parser passes a live_options * in state->child_inputs[]. Parents have --every, the scene
 * and the heading of group 5. */
extern const struct argp live_argp;

/* Reports a usage error if options contradict each other. */
void live_options_check(struct argp_state *state, const live_options *options);
/* Whether JSON lines take the place of all text on stdout. */
bool live_options_print_lines(const live_options *options);
/* Returns the first option given that needs a stream, also a setting, or NULL. */
const char *live_options_given(const live_options *options, const t3r_config *config);

#endif
