/* One video node: opened, agreed with on a format, streaming into mapped buffers. Knows nothing of pairs. */
#ifndef T3R_PLATFORM_V4L2_NODE_H
#define T3R_PLATFORM_V4L2_NODE_H

#include <stdbool.h>
#include <stdint.h>

#include "capture.h"
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
    const char *path; /* the caller's */
    int fd;           /* -1: closed */
    const t3r_v4l2_format *format;
    uint32_t width, height, stride;
    uint32_t row_bytes;    /* of a row without padding */
    uint32_t needed_bytes; /* up to the last pixel; 0 of MJPG */
    t3r_v4l2_buffer buffers[T3R_V4L2_MOST_BUFFERS];
    uint32_t buffer_count;
    bool streaming;
    bool monotonic;      /* its stamps are CLOCK_MONOTONIC; else they are taken on arrival */
    bool end_of_frame;   /* stamps are of its end, not of the start of its exposure */
    int64_t interval_ns; /* between frames, as agreed or measured; 0: unknown */
    bool has_sequence;   /* next_sequence is known */
    uint32_t next_sequence;
    int64_t last_stamp_ns;
    uint32_t slow;    /* gaps in so many of the next frames are the caller's doing */
    uint32_t refused; /* calls in a row that failed with EIO */
} t3r_v4l2_node;

/* What came of t3r_v4l2_node_fetch(). */
typedef enum t3r_v4l2_fetched {
    T3R_V4L2_NONE,   /* nothing ready */
    T3R_V4L2_IMAGE,  /* a whole one */
    T3R_V4L2_BROKEN, /* one that cannot be used; its buffer is the driver's again */
    T3R_V4L2_FAULT,  /* a call failed that may succeed next time */
    T3R_V4L2_GONE,   /* the node must be opened anew */
} t3r_v4l2_fetched;

typedef struct t3r_v4l2_image {
    uint32_t buffer, sequence, bytes;
    int64_t stamp_ns, arrived_ns;
    uint32_t missed; /* frames between the one before and this one */
    bool slow;       /* missed because the caller was */
} t3r_v4l2_image;

/* Opens, negotiates, maps and starts. 0, or -1 with a reason; the node is closed then. */
int t3r_v4l2_node_open(t3r_v4l2_node *node, const t3r_v4l2_system *system, const char *path, bool depth,
                       const t3r_capture_settings *settings, bool *rate_kept, char *error, size_t error_bytes);
void t3r_v4l2_node_close(t3r_v4l2_node *node);

/* Dequeues one image without waiting. what[] says why it is not one. */
t3r_v4l2_fetched t3r_v4l2_node_fetch(t3r_v4l2_node *node, bool error_polled, t3r_v4l2_image *image, char *what,
                                     size_t what_bytes);
/* Gives a buffer back to the driver: 0, or the errno of the refusal; it then stays ours until the next try. */
int t3r_v4l2_node_requeue(t3r_v4l2_node *node, uint32_t buffer);
/* Buffers that the driver holds. */
uint32_t t3r_v4l2_node_queued(const t3r_v4l2_node *node);
/* The caller was away for so long: from how long on frames are lost for want of buffers is known here. */
void t3r_v4l2_node_was_away(t3r_v4l2_node *node, int64_t away_ns);
/* Whether the node reported by an event that its format is no longer valid. */
bool t3r_v4l2_node_changed(t3r_v4l2_node *node);

#endif
