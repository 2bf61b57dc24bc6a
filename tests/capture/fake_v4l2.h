/* SPDX-License-Identifier: Apache-2.0 */
/* A V4L2 driver in this process, below the table of system calls: at most two nodes, a clock that advances only
 * while someone waits, and faults on demand. It is as strict as the kernel's queue: it detects buffers that are
 * queued twice, or mapped and never unmapped. */
#ifndef T3R_TESTS_FAKE_V4L2_H
#define T3R_TESTS_FAKE_V4L2_H

#include <stdbool.h>
#include <stdint.h>

#include <linux/videodev2.h>

#include "capture/v4l2_system.h"

enum { FAKE_NODES = 2, FAKE_BUFFERS = 32, FAKE_SIZES = 4, FAKE_FORMATS = 8, FAKE_FAULTS = 8 };

/* Calls other than ioctls, as fault targets. */
enum { FAKE_OPEN = 1, FAKE_MAP, FAKE_POLL, FAKE_ANY };

/* Fails the `skip`-th call of this kind and the `times` - 1 calls after it with this errno. */
typedef struct fake_fault {
    unsigned long call;
    uint32_t skip, times;
    int error;
} fake_fault;

typedef struct fake_size {
    uint32_t width, height;
    uint32_t rate; /* frames a second at most; 0 = not listed */
} fake_size;

typedef struct fake_node {
    /* properties */
    const char *path;
    uint32_t capabilities; /* 0: capture and streaming */
    uint32_t formats[FAKE_FORMATS];
    fake_size sizes[FAKE_SIZES]; /* of every format; none: not listed */
    uint32_t padding;            /* bytes after each row */
    uint32_t field;              /* 0: progressive */
    uint32_t timestamp_flags;    /* 0: monotonic, at the end of a frame */
    int64_t first_ns, interval_ns;
    uint32_t first_sequence;
    uint32_t most_buffers; /* most buffers that it provides; 0 = as many as requested */
    /* fills the image `number` (from 0, including images without a buffer); returns its bytes */
    uint32_t (*fill)(void *user, const struct fake_node *node, uint32_t number, uint8_t *memory);
    void *user;

    /* faults, by the number of the image; UINT32_MAX = never */
    uint32_t flag_error_at, short_at, empty_at, wrong_index_at;
    uint32_t drop_from, drop_count; /* images that the driver loses */
    uint32_t stall_at;              /* none from here on */
    uint32_t unplug_at;             /* ENODEV from this image until it is closed */
    uint32_t fatal_at;              /* POLLERR, EIO from this image until it is closed */
    uint32_t change_at;             /* the source changes: an event */
    bool ready_lies;                /* poll reports ready, but DQBUF has nothing */
    bool stays;                     /* the fault persists after closing */
    int64_t jitter_ns[8];           /* added to stamps, by number modulo 8 */

    /* state */
    struct v4l2_pix_format format;
    uint32_t opened, buffer_count, mapped;
    uint8_t *memory[FAKE_BUFFERS];
    uint32_t bytes;
    int state[FAKE_BUFFERS]; /* owner of a buffer: 0 the caller, 1 queued, 2 done */
    uint32_t queue[FAKE_BUFFERS], done[FAKE_BUFFERS];
    struct v4l2_buffer filled[FAKE_BUFFERS];
    uint32_t queued, finished;
    uint32_t number; /* of the next image */
    int64_t next_ns;
    bool streaming, subscribed, changed, gone;
} fake_node;

typedef struct fake_v4l2 {
    fake_node node[FAKE_NODES];
    uint32_t nodes;
    int64_t now_ns;
    fake_fault faults[FAKE_FAULTS];
    uint64_t calls;   /* of any kind that can fail */
    uint32_t misused; /* buffers queued twice, foreign descriptors, unknown ioctls */
} fake_v4l2;

/* Starts a driver with one node that gives YUYV 32x16, 30 frames a second, and never fails. */
void fake_start(fake_v4l2 *fake);
/* Adds a second node that gives Z16 of the same size. */
void fake_add_depth(fake_v4l2 *fake);
t3r_v4l2_system fake_system(fake_v4l2 *fake);
/* Lets time pass: the driver works on without being called. */
void fake_sleep(fake_v4l2 *fake, int64_t ns);
/* Whether everything is closed and unmapped, and nothing was misused. */
bool fake_clean(const fake_v4l2 *fake);
/* Returns the bytes of an image in the negotiated format, all planes included. */
uint32_t fake_image_bytes(const fake_node *node);
/* Returns byte i of the default image `number`. */
uint8_t fake_byte(uint32_t number, uint32_t i);

#endif
