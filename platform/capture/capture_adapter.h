/* SPDX-License-Identifier: Apache-2.0 */
/* The interface that an adapter implements. Its state starts with a t3r_capture whose operations point back to it. */
#ifndef T3R_PLATFORM_CAPTURE_ADAPTER_H
#define T3R_PLATFORM_CAPTURE_ADAPTER_H

#include "trim3r_capture.h"

#define T3R_CAPTURE_NOTE_BYTES 512

typedef struct t3r_capture_operations {
    /* Implements t3r_capture_next(); the reason of a failure goes into capture->error. */
    int (*next)(t3r_capture *capture, t3r_capture_frame *frame);
    /* Implements t3r_capture_reopen(); NULL: this source cannot be reopened. */
    int (*reopen)(t3r_capture *capture);
    /* Frees everything, including the capture. */
    void (*close)(t3r_capture *capture);
} t3r_capture_operations;

struct t3r_capture {
    const t3r_capture_operations *operations;
    const char *clock;
    bool recorded; /* stamps are from the time of recording */
    uint64_t depth_unit_q40;
    t3r_capture_counts counts;
    int64_t last_stamp_ns; /* stamp of the frame delivered last */
    void (*hear)(void *user, const t3r_capture_event *event);
    void *hear_user;
    char error[256]; /* "" until something goes wrong */
    char note[T3R_CAPTURE_NOTE_BYTES];
};

#define T3R_DEFAULT_DEPTH_UNIT_Q40 UINT64_C(1099511628) /* 0.001 */

/* Adds a line to the note. */
void t3r_capture_remark(t3r_capture *capture, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Counts the event and passes it to the listener. A stamp of 0 is replaced by the last frame's. */
void t3r_capture_tell(t3r_capture *capture, t3r_capture_event event);
/* Sets the reason and reports that the device is lost. Returns T3R_CAPTURE_LOST. */
int t3r_capture_lose(t3r_capture *capture, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Counts a frame that is about to be delivered. Returns T3R_CAPTURE_FRAME. */
int t3r_capture_deliver(t3r_capture *capture, const t3r_capture_frame *frame);

/* Fills in every default. Returns NULL, or which setting is out of range. */
const char *t3r_capture_settings_fill(const t3r_capture_settings *settings, t3r_capture_settings *filled);

/* A row of the table of sources (capture_sources.c). Each adapter defines its own, as t3r_source_NAME. */
typedef struct t3r_capture_source {
    const char *name;     /* before the colon: "replay" */
    const char *argument; /* after the colon, in messages: "FILE" */
    const char *module;   /* the module that it needs (host/module.h), or NULL */
    const char *says;     /* what it reads */
    /* Opens the source with filled settings. Returns NULL with a reason in error[] on failure. */
    t3r_capture *(*open)(const char *what, const t3r_capture_settings *settings, char *error, size_t error_bytes);
    /* Passes a line for each device to `say`; NULL: this source cannot list devices. */
    void (*devices)(void (*say)(void *user, const char *line), void *user);
} t3r_capture_source;

/* Opens the adapter `replay` on a recording that is played `times` times. */
t3r_capture *t3r_replay_open_repeated(const char *path, uint32_t times, char *error, size_t error_bytes);

#endif
