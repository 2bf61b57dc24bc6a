/* SPDX-License-Identifier: Apache-2.0 */
/* `trim3r replay --stream`: adds a recording's frames in order, keyframes into one bounded map; the others are held
 * out. */
#ifndef TRIM3R_TOOLS_REPLAY_STREAM_H
#define TRIM3R_TOOLS_REPLAY_STREAM_H

#include <stdint.h>

#include "reconstruction/reconstruction.h"
#include "reconstruction/replay/replay_expectation.h"
#include "recording/recording.h"

#define REPLAY_STREAM_EVERY 3u
#define REPLAY_STREAM_AT_HAND 4u

typedef struct replay_stream_options {
    uint32_t every;      /* interval between keyframes in frames; 0 = REPLAY_STREAM_EVERY */
    uint32_t overlap_q8; /* if not 0: a frame is also a keyframe when its overlap with the last keyframe is less */
    uint32_t at_hand;    /* live keyframes, whose planes are kept; 0 = REPLAY_STREAM_AT_HAND */
    const char *images;  /* folder for the views drawn; NULL = none */
    const char *output;  /* scene file of the final map; NULL = none */
    bool no_hash;        /* time the keyframes without the hashes of their stages */
    bool json;
} replay_stream_options;

/* Makes frames 0, every, 2 every ... keyframes, or more by overlap_q8. A frame between two keyframes is drawn when the
 * later one has been taken, and all are drawn once more from the final map, which is then written. Returns an exit
 * status of cli.h. */
int replay_stream(const replay_stream_options *options, const t3r_recording *recording, const char *path,
                  const reconstruction_options *settings, const expectation *e);

#endif
