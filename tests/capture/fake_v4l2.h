/* SPDX-License-Identifier: Apache-2.0 */
/* A V4L2 driver in this process, behind the table of system calls: two nodes at most, a clock of its own that moves
 * only when somebody waits, and faults on order. It is as strict as the kernel's own queue: buffers that are queued
 * twice or mapped and forgotten are found. */
#ifndef T3R_TESTS_FAKE_V4L2_H
#define T3R_TESTS_FAKE_V4L2_H

#include <stdbool.h>
#include <stdint.h>

#include <linux/videodev2.h>

#include "capture/v4l2_system.h"

enum { FAKE_NODES = 2, FAKE_BUFFERS = 32, FAKE_SIZES = 4, FAKE_FORMATS = 8, FAKE_FAULTS = 8 };

/* Calls that are no ioctl, as fault targets. */
enum { FAKE_OPEN = 1, FAKE_MAP, FAKE_POLL, FAKE_ANY };

/* The `skip`-th call of this kind and `times` - 1 after it fail with this errno. */
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
    /* what it is */
    const char *path;
    uint32_t capabilities; /* 0: capture and streaming */
    uint32_t formats[FAKE_FORMATS];
    fake_size sizes[FAKE_SIZES]; /* of every format; none: not listed */
    uint32_t padding;            /* bytes behind each row */
    uint32_t field;              /* 0: progressive */
    uint32_t timestamp_flags;    /* 0: monotonic, at the end of a frame */
    int64_t first_ns, interval_ns;
    uint32_t first_sequence;
    uint32_t most_buffers; /* it gives no more; 0 = as many as are asked for */
    /* fills the image `number` (from 0, those too that find no buffer); returns its bytes */
    uint32_t (*fill)(void *user, const struct fake_node *node, uint32_t number, uint8_t *memory);
    void *user;

    /* what befalls it, by the number of the image; UINT32_MAX = never */
    uint32_t flag_error_at, short_at, empty_at, wrong_index_at;
    uint32_t drop_from, drop_count; /* images that the driver loses */
    uint32_t stall_at;              /* none from here on */
    uint32_t unplug_at;             /* ENODEV from here on, until it is closed */
    uint32_t fatal_at;              /* POLLERR, EIO from here on, until it is closed */
    uint32_t change_at;             /* the source changes: an event */
    bool ready_lies;                /* poll says ready, DQBUF has nothing */
    bool stays;                     /* closing it mends nothing */
    int64_t jitter_ns[8];           /* added to stamps, by number modulo 8 */

    /* its state */
    struct v4l2_pix_format format;
    uint32_t opened, buffer_count, mapped;
    uint8_t *memory[FAKE_BUFFERS];
    uint32_t bytes;
    int state[FAKE_BUFFERS]; /* whose a buffer is: 0 the caller's, 1 queued, 2 done */
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
    uint32_t misused; /* buffers queued twice, foreign descriptors, ioctls that nobody knows */
} fake_v4l2;

/* One node that gives YUYV 32x16, 30 frames a second, and never fails. */
void fake_start(fake_v4l2 *fake);
/* A second one that gives Z16 of the same size. */
void fake_add_depth(fake_v4l2 *fake);
t3r_v4l2_system fake_system(fake_v4l2 *fake);
/* Time passes: the driver goes on without being asked. */
void fake_sleep(fake_v4l2 *fake, int64_t ns);
/* Whether everything is closed and unmapped, and nothing was misused. */
bool fake_clean(const fake_v4l2 *fake);
/* Bytes of row y, plane and all, of the format agreed on. */
uint32_t fake_image_bytes(const fake_node *node);
/* What the default image `number` holds at byte i. */
uint8_t fake_byte(uint32_t number, uint32_t i);

#endif
