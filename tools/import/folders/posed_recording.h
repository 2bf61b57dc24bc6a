/* SPDX-License-Identifier: Apache-2.0 */
/* Writes a recording again, with changed frames. */
#ifndef TRIM3R_TOOLS_POSED_RECORDING_H
#define TRIM3R_TOOLS_POSED_RECORDING_H

#include <stdio.h>

#include "cli/options/recording_options.h"
#include "cli/text/text_list.h"
#include "recording/recording.h"

/* Changes frame `index` before it is written; what it points to stays valid until the next call. Returns 0, or -1 with
 * a reason. */
typedef struct posed_recording_change {
    int (*make)(void *user, uint32_t index, t3r_capture_frame *frame, char *error, size_t error_bytes);
    void *user;
} posed_recording_change;

typedef struct posed_recording_totals {
    uint32_t frames, depth_frames, posed_frames, triplets;
    uint64_t bytes; /* filled in by the caller */
} posed_recording_totals;

/* Frames that cannot be read. */
typedef struct posed_recording_losses {
    bool strict; /* they are errors; otherwise they are left out */
    bool *gone;  /* one per frame of the recording */
    uint32_t gone_count;
    uint32_t part_count;     /* frames without depth or pose, which cannot be read */
    uint32_t depth_count;    /* those without depth */
    text_list frames, parts; /* the first POSED_RECORDING_LINES of both, with the reasons */
} posed_recording_losses;
#define POSED_RECORDING_LINES 20u

/* Returns 0, or -1 without memory. */
int posed_recording_losses_open(posed_recording_losses *losses, uint32_t frames, bool strict);
/* Marks a frame that cannot be read. Returns 0, or -1 with `why` in error[]: in strict mode, or without memory. */
int posed_recording_lose(posed_recording_losses *losses, uint32_t index, const char *why, char *error,
                         size_t error_bytes);
void posed_recording_losses_close(posed_recording_losses *losses);

/* Writes the frames of a recording that are not gone, with their current poses (t3r_recording_set_pose()) and the
 * original format, stamps, depth, intrinsics and triplets. source: stored in the new recording as its origin. Returns
 * 0; POSED_RECORDING_AGAIN if frames turned out to be gone that triplets may name, to be called once more for a new
 * file; or -1 with "frame N: why" in error[], also if all frames are gone or none of their depth can be read. */
enum { POSED_RECORDING_AGAIN = 1 };
int posed_recording_write(const t3r_recording *recording, const char *source, const recording_options *stored,
                          const posed_recording_change *change, FILE *stream, posed_recording_losses *losses,
                          posed_recording_totals *totals, char *error, size_t error_bytes);

#endif
