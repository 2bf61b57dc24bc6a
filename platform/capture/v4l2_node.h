/* SPDX-License-Identifier: Apache-2.0 */
/* One video node: opened, format negotiated, streaming into mapped buffers. It knows nothing of pairs. */
#ifndef T3R_PLATFORM_V4L2_NODE_H
#define T3R_PLATFORM_V4L2_NODE_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r_capture.h"
#include "v4l2_format.h"
#include "v4l2_system.h"

#define T3R_V4L2_MOST_BUFFERS 32u

typedef struct t3r_v4l2_buffer {
    void *memory;
    size_t bytes;
    bool in_driver;
} t3r_v4l2_buffer;

typedef struct t3r_v4l2_node {
    const t3r_v4l2_system *system;
    const char *path; /* owned by the caller */
    int fd;           /* -1: closed */
    const t3r_v4l2_format *format;
    uint32_t width, height, stride;
    uint32_t row_bytes;    /* without padding */
    uint32_t needed_bytes; /* up to the last pixel; 0 for MJPG */
    t3r_v4l2_buffer buffers[T3R_V4L2_MOST_BUFFERS];
    uint32_t buffer_count;
    bool streaming;
    bool monotonic;      /* stamps are CLOCK_MONOTONIC; else they are taken on arrival */
    bool end_of_frame;   /* stamps mark the end of the frame, not the start of exposure */
    int64_t interval_ns; /* between frames, negotiated or measured; 0: unknown */
    bool has_sequence;   /* next_sequence is known */
    uint32_t next_sequence;
    int64_t last_stamp_ns;
    uint32_t slow;    /* number of next frames within which gaps are due to the caller */
    uint32_t refused; /* consecutive calls that failed with EIO */
} t3r_v4l2_node;

/* Result of t3r_v4l2_node_fetch(). */
typedef enum t3r_v4l2_fetched {
    T3R_V4L2_NONE,   /* nothing ready */
    T3R_V4L2_IMAGE,  /* a good image */
    T3R_V4L2_BROKEN, /* an unusable image; its buffer was queued again */
    T3R_V4L2_FAULT,  /* a call failed that may succeed next time */
    T3R_V4L2_GONE,   /* the node must be reopened */
} t3r_v4l2_fetched;

typedef struct t3r_v4l2_image {
    uint32_t buffer, sequence, bytes;
    int64_t stamp_ns, arrived_ns;
    uint32_t missed; /* frames lost between the previous one and this one */
    bool slow;       /* missed because the caller was slow */
} t3r_v4l2_image;

/* Opens, negotiates, maps and starts a node. Returns 0, or -1 with a reason and the node closed. */
int t3r_v4l2_node_open(t3r_v4l2_node *node, const t3r_v4l2_system *system, const char *path, bool depth,
                       const t3r_capture_settings *settings, bool *rate_kept, char *error, size_t error_bytes);
void t3r_v4l2_node_close(t3r_v4l2_node *node);

/* Dequeues one image without waiting. what[] says why there is none. */
t3r_v4l2_fetched t3r_v4l2_node_fetch(t3r_v4l2_node *node, bool error_polled, t3r_v4l2_image *image, char *what,
                                     size_t what_bytes);
/* Gives a buffer back to the driver. Returns 0, or the errno of the refusal; the buffer then stays ours until the next
 * try. */
int t3r_v4l2_node_requeue(t3r_v4l2_node *node, uint32_t buffer);
/* Returns the number of buffers that the driver holds. */
uint32_t t3r_v4l2_node_queued(const t3r_v4l2_node *node);
/* Records how long the caller was away; from this the node decides whether frames were lost for want of buffers. */
void t3r_v4l2_node_was_away(t3r_v4l2_node *node, int64_t away_ns);
/* Whether the node reported that its format is no longer valid. */
bool t3r_v4l2_node_changed(t3r_v4l2_node *node);

#endif
