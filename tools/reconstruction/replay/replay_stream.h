/* SPDX-License-Identifier: Apache-2.0 */
/* `trim3r replay --stream`: adds a recording's frames in order, keyframes into one bounded map; the others are held
 * out. */
#ifndef TRIM3R_TOOLS_REPLAY_STREAM_H
#define TRIM3R_TOOLS_REPLAY_STREAM_H

#include <stdint.h>

#include "reconstruction/live/live_options.h"
#include "reconstruction/reconstruction.h"
#include "reconstruction/replay/replay_expectation.h"
#include "recording/recording.h"

typedef struct replay_stream_options {
    live_options live;
    bool has_until;
    uint32_t until_frame; /* the last frame; UINT32_MAX = by time */
    uint64_t until_ns;    /* the last time, from the first frame on */
    const char *images;   /* folder for the views drawn; NULL = none */
    uint32_t rounds;      /* in which keyframes are shown again after the last frame */
    bool no_hash;         /* time the keyframes without the hashes of their stages */
    bool json;
} replay_stream_options;

/* Makes frames 0, every, 2 every ... keyframes, or more by overlap_q8. A frame between two keyframes is drawn when the
 * later one has been taken, and all are drawn once more from the final map, after that was written. Returns an exit
 * status of cli.h. */
int replay_stream(const replay_stream_options *options, const t3r_recording *recording, const char *path,
                  const reconstruction_options *settings, const expectation *e);

#endif
