/* SPDX-License-Identifier: Apache-2.0 */
/* One interface over every source of frames: recordings (`replay`), V4L2, libcamera, OpenCV. Part of the host library.
 *
 * An adapter opens a source; the caller asks for frames one after the other and closes it. A frame's memory, the
 * driver's own buffer if there is one, stays valid until the next call on the same source. Only the calls that open may
 * wait longer than the deadline (OpenCV's back ends have their own, at most 10 s). Nothing is allocated after opening,
 * except by MJPEG and OpenCV. */
#ifndef TRIM3R_CAPTURE_H
#define TRIM3R_CAPTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"
#include "trim3r_program.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One captured frame, ready for t3r_add_view() once pose and intrinsics are known. */
typedef struct t3r_capture_frame {
    uint32_t index;         /* order among the colour images of the source, from 0 */
    uint32_t sequence;      /* the driver's count, with gaps; in recordings the index */
    int64_t stamp_ns;       /* time of the colour image, in the source's clock */
    int64_t depth_stamp_ns; /* time of the depth image; equal to stamp_ns if they are one image */
    bool has_pose;          /* camera's pose is known; else its rotation is 0 0 0 0, which the runtime refuses */
    bool has_intrinsics;    /* camera's intrinsics are known */
    bool straightened;      /* redrawn without the lens's distortion, which `camera` cannot hold */
    t3r_frame frame;        /* frame.depth is NULL without depth */
    t3r_camera camera;      /* with intrinsics, for the frame's size */
} t3r_capture_frame;

/* Outcomes of asking for a frame. */
enum {
    T3R_CAPTURE_LOST = -2,   /* the device is gone, stalled or changed its format: t3r_capture_reopen() */
    T3R_CAPTURE_FAILED = -1, /* this frame failed; the next one may be good */
    T3R_CAPTURE_END = 0,     /* there are no more frames */
    T3R_CAPTURE_FRAME = 1,
    T3R_CAPTURE_NOTHING = 2, /* no frame by the deadline, or a signal came: ask again */
};

typedef struct t3r_capture t3r_capture;

/* Fetches the next frame. Returns one of the outcomes above; t3r_capture_error() has the reason for LOST and FAILED. */
int t3r_capture_next(t3r_capture *capture, t3r_capture_frame *frame);
/* Closes the device and opens it again with the same settings; memory of earlier frames becomes invalid. Returns
 * T3R_CAPTURE_FRAME: reopened; T3R_CAPTURE_LOST: the device is not there (yet); T3R_CAPTURE_END: this source cannot be
 * reopened. */
int t3r_capture_reopen(t3r_capture *capture);
/* Returns the error and its place, or "". Lives as long as the source. */
const char *t3r_capture_error(const t3r_capture *capture);
/* Closes the source. NULL is allowed. */
void t3r_capture_close(t3r_capture *capture);

/* ---- properties of a source ---- */

/* Returns the name of the clock of the stamps: "monotonic" and "boottime" (the system's clocks of these names),
 * "arrival" (monotonic, taken when the frame was fetched, because the driver's stamps name no clock), "stream" (from
 * the start of a film), "synthetic" or "unknown". For a recording, the clock it was recorded with. */
const char *t3r_capture_clock(const t3r_capture *capture);
/* Whether frames come from a recording; stamps then belong to the time of recording, whatever the clock's name. */
bool t3r_capture_recorded(const t3r_capture *capture);
/* Returns the negotiated formats, sizes, rates and buffers, and other remarks for the user, as lines. Never NULL. */
const char *t3r_capture_note(const t3r_capture *capture);
/* Returns a step of depth in world units, Q40. */
uint64_t t3r_capture_depth_unit_q40(const t3r_capture *capture);

/* Counts; every frame that does not arrive is counted once, under its cause. */
typedef struct t3r_capture_counts {
    uint64_t frames;         /* delivered */
    uint64_t paired;         /* delivered with depth */
    uint64_t dropped_driver; /* gaps in the driver's sequence while it had buffers */
    uint64_t dropped_slow;   /* such gaps after the caller held a frame longer than the other buffers last */
    uint64_t corrupted;      /* flagged by the driver, too short, or not a JPEG */
    uint64_t alone;          /* delivered without depth although depth is captured, because none was near */
    uint64_t depth_dropped;  /* depth images with no colour image near, and gaps in their sequence */
    uint64_t faults;         /* refused calls that lost no frame: EIO, a buffer that could not be queued at once */
    uint64_t reopened;       /* successful t3r_capture_reopen() */
} t3r_capture_counts;
t3r_capture_counts t3r_capture_counts_of(const t3r_capture *capture);

/* ---- events: everything that is counted, and every pairing, reported as it happens ---- */

typedef enum t3r_capture_event_kind {
    T3R_EVENT_PAIRED,         /* sequence, depth_sequence, gap_ns = depth's stamp minus colour's */
    T3R_EVENT_ALONE,          /* sequence; gap_ns to the nearest depth, INT64_MAX if there is none */
    T3R_EVENT_DEPTH_ALONE,    /* depth_sequence */
    T3R_EVENT_DROPPED_DRIVER, /* count frames before sequence */
    T3R_EVENT_DROPPED_SLOW,   /* count frames before sequence */
    T3R_EVENT_DEPTH_DROPPED,  /* count images before depth_sequence */
    T3R_EVENT_CORRUPTED,      /* sequence; detail says why */
    T3R_EVENT_FAULT,          /* detail */
    T3R_EVENT_LOST,           /* detail */
    T3R_EVENT_REOPENED,
    T3R_EVENT_KIND_COUNT
} t3r_capture_event_kind;

typedef struct t3r_capture_event {
    t3r_capture_event_kind kind;
    int64_t stamp_ns; /* of the frame, else of the last frame */
    uint32_t sequence, depth_sequence;
    int64_t gap_ns;
    uint64_t count;
    const char *detail; /* "" or a reason; valid during the call */
} t3r_capture_event;

/* Sets the listener. `hear` is called from within t3r_capture_next() and t3r_capture_reopen(); NULL removes it. */
void t3r_capture_listen(t3r_capture *capture, void (*hear)(void *user, const t3r_capture_event *event), void *user);
#define T3R_CAPTURE_EVENT_BYTES 256
/* Formats an event as one line, such as "colour 12 with depth 13, +3.201 ms". */
const char *t3r_capture_event_text(const t3r_capture_event *event, char text[T3R_CAPTURE_EVENT_BYTES]);

/* ---- opening ---- */

/* Settings requested of live sources. 0 or NULL means the default. Strings must outlive the source. */
typedef struct t3r_capture_settings {
    uint32_t width, height;             /* the device's nearest size is taken; default 640x480 */
    uint32_t rate_millihertz;           /* 30000 is 30 frames a second; default: the device's */
    const char *format;                 /* a FourCC from t3r_capture_formats(); default: the first that fits */
    const char *depth;                  /* the device of depth images; NULL: colour only */
    uint32_t depth_width, depth_height; /* default: colour's size */
    uint64_t depth_unit_q40;            /* a step of the device's 16-bit depth; default 0.001 */
    uint32_t buffers;                   /* per stream, 2..32; default 4 */
    uint32_t deadline_ms;               /* longest wait of t3r_capture_next(), 1..60000; default 100 */
    uint32_t stall_ms;                  /* time without a frame after which the device counts as LOST; default 3000 */
    uint32_t pair_ms;                   /* largest gap between colour and depth of one instant; default 20 */
    uint32_t repeat;                    /* `replay`: passes over the recording, with a continuous clock; default 1 */
    const char *backend;                /* `opencv`: FFMPEG, V4L2, IMAGES, CV_MJPEG, GSTREAMER; default: its choice */
} t3r_capture_settings;

/* Returns the formats of this build in the order in which they are tried: "YUYV UYVY NV12 RGB3 BGR3 GREY MJPG". */
const char *t3r_capture_formats(void);

/* Returns what a program was compiled with, for the two calls that follow. */
#define T3R_CAPTURE_TYPES_(X)                                                                                          \
    X(t3r_capture_frame)                                                                                               \
    X(t3r_capture_counts)                                                                                              \
    X(t3r_capture_event)                                                                                               \
    X(t3r_capture_settings)
#define T3R_CAPTURE_FIELDS_(X)                                                                                         \
    X(t3r_capture_frame, stamp_ns)                                                                                     \
    X(t3r_capture_frame, has_pose)                                                                                     \
    X(t3r_capture_frame, has_intrinsics)                                                                               \
    X(t3r_capture_frame, frame)                                                                                        \
    X(t3r_capture_frame, camera)                                                                                       \
    X(t3r_capture_counts, reopened)                                                                                    \
    X(t3r_capture_event, detail)                                                                                       \
    X(t3r_capture_settings, format)                                                                                    \
    X(t3r_capture_settings, depth_unit_q40)                                                                            \
    X(t3r_capture_settings, backend)
static inline t3r_program t3r_capture_program(void)
{
    uint64_t digest = t3r_header_interface();
    T3R_CAPTURE_TYPES_(T3R_DIGEST_TYPE_)
    T3R_CAPTURE_FIELDS_(T3R_DIGEST_FIELD_)
    return t3r_program_of(digest);
}

/* Opens "replay:FILE", "v4l2:/dev/video0", "libcamera:0" or "opencv:URL". Returns NULL with a reason in error[] on
 * failure, also if the program was compiled with other headers than the library. */
t3r_capture *t3r_capture_open_as(t3r_program program, const char *source, const t3r_capture_settings *settings,
                                 char *error, size_t error_bytes);
static inline t3r_capture *t3r_capture_open(const char *source, const t3r_capture_settings *settings, char *error,
                                            size_t error_bytes)
{
    return t3r_capture_open_as(t3r_capture_program(), source, settings, error, error_bytes);
}

/* Opens the adapter `replay`: the frames of an MCAP recording. Returns NULL with a reason in error[] on failure. */
t3r_capture *t3r_replay_open_as(t3r_program program, const char *path, char *error, size_t error_bytes);
static inline t3r_capture *t3r_replay_open(const char *path, char *error, size_t error_bytes)
{
    return t3r_replay_open_as(t3r_capture_program(), path, error, error_bytes);
}

/* An adapter, in this build or missing from it. t3r_capture_devices() passes a line for each device found to `say`. */
typedef struct t3r_capture_adapter {
    const char *name;
    bool available;
    char says[256]; /* what it reads, or why it is missing */
} t3r_capture_adapter;
uint32_t t3r_capture_adapter_count(void);
t3r_capture_adapter t3r_capture_adapter_of(uint32_t index);
void t3r_capture_devices(const char *adapter, void (*say)(void *user, const char *line), void *user);

#ifdef __cplusplus
}
#endif
#endif
