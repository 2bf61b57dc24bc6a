/* The loop of `trim3r capture`: frames from a source to a recording, to Gaussians, or to both. Nothing is allocated
 * once the first frame is there, or, with a build, the first that it uses. */
#ifndef TRIM3R_TOOLS_CAPTURE_RUN_H
#define TRIM3R_TOOLS_CAPTURE_RUN_H

#include <signal.h>
#include <stdbool.h>
#include <stdint.h>

#include "capture/capture.h"
#include "capture/record.h"
#include "capture/live_build.h"
#include "import/poses/trajectory.h"

typedef struct capture_plan {
    const char *source;                    /* its name for messages and the recording */
    const char *output;                    /* NULL = no recording */
    uint64_t max_bytes;                    /* of a recording's file; 0 = no end */
    bool sync;                             /* every message to the disk */
    recording_options stored;              /* how messages are stored */
    const trajectory *poses;               /* NULL = the source's own */
    int64_t offset_ns;                     /* their clock less the camera's */
    const t3r_recorded_camera *intrinsics; /* NULL = the source's own; its size is the frames' */
    uint64_t frames;                       /* stop after so many; 0 = no end */
    double seconds;                        /* stop after so long; 0 = no end */
    double reconnect_seconds;              /* try so long to open a lost device again */
    const reconstruction_options *build;   /* NULL = no Gaussians */
    uint32_t every;    /* build anew with each N-th frame and the one N before; 0: once, of build->context */
    const char *scene; /* where the newest scene goes; NULL = nowhere */
    int scene_flags;
    bool hash;                         /* of all frames */
    const volatile sig_atomic_t *stop; /* not 0: stop with what there is */
    bool quiet;                        /* no progress line */
} capture_plan;

typedef struct capture_times {
    uint64_t count;
    double sum_ms, worst_ms;
} capture_times;

typedef struct capture_account {
    uint64_t frames, failed, unposed;
    uint32_t width, height;
    t3r_pixel_format format;
    double seconds;        /* from the first frame to the last */
    capture_times latency; /* from a frame's stamp until all was done with it; where its clock is the system's */
    capture_times work;    /* recording and building a frame */
    capture_times recording, building, writing; /* of these: into the recording; a scene; its file */
    uint64_t frames_hash;                       /* FNV-1a over what was delivered, in order */
    uint32_t files;
    uint64_t bytes;
    uint32_t builds, gaussians, valid_points;
    uint32_t context[T3R_MAX_VIEWS], context_count; /* of the last build */
    uint64_t scene_hash;                            /* of the last build, as `build --json` has it */
    size_t arena_bytes;
    t3r_capture_counts counts;
} capture_account;

/* Runs until the source ends, a limit is reached or *stop is set: CLI_OK; or an exit status after a message. The
 * recording is whole in either case. */
int capture_run(t3r_capture *capture, const capture_plan *plan, capture_account *account);

/* The hash of all frames, with one more. */
uint64_t capture_frame_hash(uint64_t hash, const t3r_capture_frame *frame);

#endif
