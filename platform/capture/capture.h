/* Capture: where frames come from. One interface over every source: recordings (`replay`), V4L2, libcamera, OpenCV.
 *
 * A source is opened by its adapter, asked for one frame after the other, and closed. Frames lend their memory, the
 * driver's own buffers where there are such: it stays valid until the next call on the same source. No call but those
 * that open waits longer than its deadline (OpenCV's back ends: their own, at most 10 s), and none allocates after
 * opening, MJPEG and OpenCV aside. */
#ifndef T3R_PLATFORM_CAPTURE_H
#define T3R_PLATFORM_CAPTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

/* One captured instant, ready for t3r_add_view() where pose and intrinsics are known. */
typedef struct t3r_capture_frame {
    uint32_t index;         /* order among the colour images of the source, from 0 */
    uint32_t sequence;      /* the driver's count, gaps and all; of recordings the index */
    int64_t stamp_ns;       /* time of the colour image, in the source's clock */
    int64_t depth_stamp_ns; /* of the depth image; stamp_ns where they are one */
    bool has_pose;          /* camera's pose is known */
    bool has_intrinsics;    /* camera's intrinsics are known */
    t3r_frame frame;        /* frame.depth is NULL when the instant has no depth */
    t3r_camera camera;
} t3r_capture_frame;

typedef struct t3r_capture t3r_capture;

enum {
    T3R_CAPTURE_LOST = -2,   /* the device is gone, stands still or changed its format: t3r_capture_reopen() */
    T3R_CAPTURE_FAILED = -1, /* this frame; the next one may be whole */
    T3R_CAPTURE_END = 0,     /* there are no more */
    T3R_CAPTURE_FRAME = 1,
    T3R_CAPTURE_NOTHING = 2, /* none yet, the deadline is over or a signal came: ask again */
};

/* The next frame: one of the values above; the reason of LOST and FAILED is in t3r_capture_error(). */
int t3r_capture_next(t3r_capture *capture, t3r_capture_frame *frame);
/* Closes the device and opens it anew, with the settings of the first time; memory of earlier frames is gone.
 * T3R_CAPTURE_FRAME: go on. T3R_CAPTURE_LOST: it is not there (yet). T3R_CAPTURE_END: this source cannot. */
int t3r_capture_reopen(t3r_capture *capture);
/* What went wrong, where; "" when nothing did. Lives as long as the source. */
const char *t3r_capture_error(const t3r_capture *capture);
void t3r_capture_close(t3r_capture *capture);

/* ---- what a source says of itself ---- */

/* Whose time the stamps are: "monotonic" and "boottime" (the system's clocks of these names), "arrival" (monotonic, but
 * taken when the frame was fetched, as the driver's stamps name no clock), "stream" (from the start of a film),
 * "synthetic", "unknown"; a recording's as it was recorded. */
const char *t3r_capture_clock(const t3r_capture *capture);
/* Whether frames come from a recording: their clock, whatever its name, is that of then. */
bool t3r_capture_recorded(const t3r_capture *capture);
/* Formats, sizes, rates and buffers that were agreed on, and what a user should know of them: lines, never NULL. */
const char *t3r_capture_note(const t3r_capture *capture);
/* Steps of depth in world units, Q40. */
uint64_t t3r_capture_depth_unit_q40(const t3r_capture *capture);

/* Every frame that does not arrive is counted once, under its cause. */
typedef struct t3r_capture_counts {
    uint64_t frames;         /* delivered */
    uint64_t paired;         /* of these with depth */
    uint64_t dropped_driver; /* gaps in the driver's sequence while it had buffers */
    uint64_t dropped_slow;   /* such gaps after the caller kept a frame for longer than the other buffers last */
    uint64_t corrupted;      /* flagged by the driver, too short, or not a JPEG */
    uint64_t alone;          /* delivered without depth though depth is captured: none was near */
    uint64_t depth_dropped;  /* depth images that no colour image is near to, and gaps in their sequence */
    uint64_t faults;         /* refused calls that cost no frame: EIO, a buffer that could not be queued at once */
    uint64_t reopened;       /* successful t3r_capture_reopen() */
} t3r_capture_counts;
t3r_capture_counts t3r_capture_counts_of(const t3r_capture *capture);

/* ---- events: everything that is counted, and every pairing, told as it happens ---- */

typedef enum t3r_capture_event_kind {
    T3R_EVENT_PAIRED,         /* sequence, depth_sequence, gap_ns = depth's stamp less colour's */
    T3R_EVENT_ALONE,          /* sequence; gap_ns to the nearest depth, INT64_MAX: there was none */
    T3R_EVENT_DEPTH_ALONE,    /* depth_sequence */
    T3R_EVENT_DROPPED_DRIVER, /* count frames before sequence */
    T3R_EVENT_DROPPED_SLOW,   /* likewise */
    T3R_EVENT_DEPTH_DROPPED,  /* count images before depth_sequence */
    T3R_EVENT_CORRUPTED,      /* sequence; detail says why */
    T3R_EVENT_FAULT,          /* detail */
    T3R_EVENT_LOST,           /* detail */
    T3R_EVENT_REOPENED,
    T3R_EVENT_KIND_COUNT
} t3r_capture_event_kind;

typedef struct t3r_capture_event {
    t3r_capture_event_kind kind;
    int64_t stamp_ns; /* of the frame, else of the last one */
    uint32_t sequence, depth_sequence;
    int64_t gap_ns;
    uint64_t count;
    const char *detail; /* "" or a reason; valid during the call */
} t3r_capture_event;

/* `hear` is called from within t3r_capture_next() and t3r_capture_reopen(); NULL: nobody listens. */
void t3r_capture_listen(t3r_capture *capture, void (*hear)(void *user, const t3r_capture_event *event), void *user);
#define T3R_CAPTURE_EVENT_BYTES 256
/* One line, such as "colour 12 with depth 13, +3.201 ms". */
const char *t3r_capture_event_text(const t3r_capture_event *event, char text[T3R_CAPTURE_EVENT_BYTES]);

/* ---- opening ---- */

/* What live sources are asked for. 0 or NULL: the default. Texts outlive the source. */
typedef struct t3r_capture_settings {
    uint32_t width, height;             /* the nearest that the device has; default 640x480 */
    uint32_t rate_millihertz;           /* 30 frames a second are 30000; default: the device's */
    const char *format;                 /* a FourCC as t3r_capture_formats() has it; default: the first that fits */
    const char *depth;                  /* the device of depth images; NULL: colour alone */
    uint32_t depth_width, depth_height; /* default: those of colour */
    uint64_t depth_unit_q40;            /* of the device's 16-bit steps; default 0.001 */
    uint32_t buffers;                   /* a stream, 2..32; default 4 */
    uint32_t deadline_ms;               /* of t3r_capture_next(), 1..60000; default 100 */
    uint32_t stall_ms;                  /* no frame for so long: LOST; default 3000 */
    uint32_t pair_ms;                   /* colour and depth of one instant are at most this far apart; default 20 */
    uint32_t repeat;     /* of `replay`: the recording so many times over, its clock going on; default 1 */
    const char *backend; /* of `opencv`: FFMPEG, V4L2, IMAGES, CV_MJPEG, GSTREAMER; default: its choice */
} t3r_capture_settings;

/* "YUYV UYVY NV12 RGB3 BGR3 GREY MJPG", those of this build, in the order in which they are tried. */
const char *t3r_capture_formats(void);

/* "replay:FILE", "v4l2:/dev/video0", "libcamera:0", "opencv:URL". NULL with a reason in error[] on failure. */
t3r_capture *t3r_capture_open(const char *source, const t3r_capture_settings *settings, char *error,
                              size_t error_bytes);

/* The adapter `replay`: the frames of an MCAP recording. NULL with a reason in error[] on failure. */
t3r_capture *t3r_replay_open(const char *path, char *error, size_t error_bytes);

/* The adapters of this build and those that it lacks: `say` gets a line of text for each, and for each device found
 * (indented). */
typedef struct t3r_capture_adapter {
    const char *name;
    bool available;
    char says[256]; /* what it reads, or why it is not there */
} t3r_capture_adapter;
uint32_t t3r_capture_adapter_count(void);
t3r_capture_adapter t3r_capture_adapter_of(uint32_t index);
void t3r_capture_devices(const char *adapter, void (*say)(void *user, const char *line), void *user);

#endif
