/* SPDX-License-Identifier: Apache-2.0 */
/* The stream of images, split into payloads (UVC 1.0, 2.4.3), one for each transfer that the host has requested. */
#ifndef T3R_TESTS_USB_STREAM_H
#define T3R_TESTS_USB_STREAM_H

#include <stdbool.h>
#include <stdint.h>

#include "camera.h"
#include "faults.h"
#include "pictures.h"
#include "usbip.h"

#define STREAM_MOST_WAITING 32u
#define STREAM_STEP 16u /* frame F of stream S is picture STREAM_STEP x S + F, modulo their number */

typedef struct stream {
    const pictures *pictures;
    const faults *faults;
    usbip_call waiting[STREAM_MOST_WAITING]; /* transfers that the host awaits, the oldest first */
    uint32_t waiting_count;
    uint8_t format;
    uint32_t begun; /* number of streams so far, including this one */
    uint32_t frame; /* number in this stream */
    uint32_t sent;  /* bytes of this frame */
    int64_t due_ns; /* earliest start of the frame */
    bool stuck;     /* stalled until the next stream */
} stream;

typedef enum stream_end { STREAM_GOES_ON, STREAM_BUS_GONE, STREAM_UNPLUG, STREAM_LEAVE } stream_end;

/* Starts a stream after the host committed to a format: frame 0 comes next. */
void stream_begin(stream *self, uint8_t format, int64_t now_ns);
/* Resets the stream for a new bus without pending transfers. */
void stream_reset(stream *self);
/* Queues a transfer to be filled; false: too many are queued. */
bool stream_ask(stream *self, const usbip_call *call);
/* Removes a transfer that the host no longer awaits; false if it has already been filled. */
bool stream_forget(stream *self, uint32_t sequence);
/* Returns when the next payload is sent; -1: the host has to act first. */
int64_t stream_next_ns(const stream *self);
/* Sends the next payload. */
stream_end stream_send(stream *self, int bus);

#endif
