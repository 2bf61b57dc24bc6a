/* Writes a recording again, with changed frames. */
#ifndef TRIM3R_TOOLS_POSED_RECORDING_H
#define TRIM3R_TOOLS_POSED_RECORDING_H

#include <stdio.h>

#include "cli/options/recording_options.h"
#include "recording/recording.h"

/* Changes frame `index` before it is written; what it points to stays valid until the next call. Returns 0, or -1 with
 * a reason. */
typedef struct posed_recording_change {
    int (*make)(void *user, uint32_t index, t3r_capture_frame *frame, char *error, size_t error_bytes);
    void *user;
} posed_recording_change;

typedef struct posed_recording_totals {
    uint32_t frames, depth_frames, posed_frames;
    uint64_t bytes; /* filled in by the caller */
} posed_recording_totals;

/* Writes all frames of a recording, with their current poses (t3r_recording_set_pose()) and the original format,
 * stamps, depth, intrinsics and triplets. source: stored in the new recording as its origin. Returns 0, or -1 with
 * "frame N: why" in error[]. */
int posed_recording_write(const t3r_recording *recording, const char *source, const recording_options *stored,
                          const posed_recording_change *change, FILE *stream, posed_recording_totals *totals,
                          char *error, size_t error_bytes);

#endif
