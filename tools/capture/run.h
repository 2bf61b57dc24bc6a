/* SPDX-License-Identifier: Apache-2.0 */
/* The loop of `trim3r capture`: frames from a source to a recording, to Gaussians, or to both. Nothing is allocated
 * after the first frame; with a build, after the first frame that it uses. */
#ifndef TRIM3R_TOOLS_CAPTURE_RUN_H
#define TRIM3R_TOOLS_CAPTURE_RUN_H

#include <signal.h>
#include <stdbool.h>
#include <stdint.h>

#include "capture/live_build.h"
#include "capture/live_stream.h"
#include "capture/record.h"
#include "import/poses/trajectory.h"
#include "reconstruction/live/latency.h"
#include "trim3r_capture.h"

typedef struct capture_plan {
    const char *source;                    /* name for messages and the recording */
    const char *output;                    /* NULL = no recording */
    uint64_t max_bytes;                    /* per recording file; 0 = no limit */
    bool sync;                             /* write every message to the disk */
    recording_options stored;              /* how messages are stored */
    const trajectory *poses;               /* NULL = the source's own */
    int64_t offset_ns;                     /* their clock minus the camera's */
    const t3r_recorded_camera *intrinsics; /* NULL = the source's own; the size must be the frames' */
    uint64_t frames;                       /* stop after this many; 0 = no limit */
    double seconds;                        /* stop after this long; 0 = no limit */
    double reconnect_seconds;              /* how long to try to reopen a lost device */
    const reconstruction_options *build;   /* NULL = no Gaussians */
    const live_options *stream;            /* a map that follows, by the settings of `build`; NULL = scenes of views */
    bool prints_table;                     /* of the map's keyframes, on stdout */
    uint32_t every;    /* build again from each N-th frame and the one N before; 0: once, from build->context */
    const char *scene; /* file for the newest scene; NULL = none */
    int scene_flags;
    bool hash;                         /* hash all frames */
    const volatile sig_atomic_t *stop; /* not 0: stop and keep what was captured */
    bool quiet;                        /* no progress line */
} capture_plan;

typedef struct capture_account {
    uint64_t frames, failed, unposed;
    uint32_t width, height;
    t3r_pixel_format format;
    double seconds; /* from the first frame to the last */
    latency late;   /* from a frame's stamp to the end of its processing; if the clock is the system's */
    latency work;   /* recording of and building from a frame */
    latency recording, building, writing; /* parts of it: into the recording; a scene; its file */
    uint64_t frames_hash;                 /* FNV-1a over the delivered frames, in order */
    uint32_t files;
    uint64_t bytes;
    uint32_t builds, gaussians, valid_points;       /* scenes; with a stream keyframes */
    uint32_t context[T3R_MAX_VIEWS], context_count; /* of the last build */
    uint64_t scene_hash; /* of the last build, as in `build --json`; of the last keyframe, as in its row */
    size_t arena_bytes;
    t3r_capture_counts counts;
} capture_account;

/* Runs until the source ends, a limit is reached or *stop is set. Returns CLI_OK, or an exit status after a message.
 * The recording is complete in either case. */
int capture_run(t3r_capture *capture, const capture_plan *plan, capture_account *account);

/* Extends the hash of all frames by one frame. */
uint64_t capture_frame_hash(uint64_t hash, const t3r_capture_frame *frame);

#endif
