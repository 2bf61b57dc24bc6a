/* SPDX-License-Identifier: Apache-2.0 */
/* The adapter `replay`: a recording's frames in order, as fast as they are asked for. */
#include <stdlib.h>

#include "capture_adapter.h"
#include "host/program_check.h"
#include "host/reason.h"
#include "recording/recording.h"

#define LONE_FRAME_NS 33333333          /* the interval assumed for a recording of a single frame */
#define MOST_AGO_NS (UINT64_C(1) << 61) /* stamps of a recording are below 2^62, so int64_t holds the sum */

typedef struct replay {
    t3r_capture capture; /* first: a t3r_capture * is a replay * */
    t3r_recording *recording;
    uint32_t next;    /* frame of the recording */
    uint32_t index;   /* over all passes */
    bool started;     /* first_ns is known */
    uint32_t turns;   /* passes left, with this one */
    int64_t first_ns; /* first stamp of the recording */
    int64_t ago_ns;   /* added to the stamps of this pass, at most MOST_AGO_NS */
    char clock[64];
} replay;

/* Starts the next pass, with stamps later by the length of a pass. Returns FRAME; END after the last pass; FAILED, with
 * no pass left, when the clock would overflow. */
static int turn_over(replay *self)
{
    if (self->turns <= 1 || self->next == 0) {
        return T3R_CAPTURE_END;
    }
    uint32_t frames = self->next;
    int64_t last_ns = self->capture.last_stamp_ns - self->ago_ns;
    uint64_t span = last_ns > self->first_ns ? (uint64_t)last_ns - (uint64_t)self->first_ns : 0;
    bool holds = span <= MOST_AGO_NS;
    uint64_t turn_ns = holds && frames > 1 && span > 0 ? span + span / (frames - 1) : LONE_FRAME_NS;
    if (!holds || turn_ns > MOST_AGO_NS - (uint64_t)self->ago_ns) {
        self->turns = 1;
        t3r_reason(self->capture.error, sizeof self->capture.error, "the clock does not hold another turn");
        return T3R_CAPTURE_FAILED;
    }
    self->ago_ns += (int64_t)turn_ns;
    self->turns--;
    self->next = 0;
    return T3R_CAPTURE_FRAME;
}

/* Delivers the next frame. A frame that cannot be read fails once; the next call goes on with the frame after it. */
static int next(t3r_capture *capture, t3r_capture_frame *frame)
{
    replay *self = (replay *)capture;
    int turned = self->next < t3r_recording_frame_count(self->recording) ? T3R_CAPTURE_FRAME : turn_over(self);
    if (turned != T3R_CAPTURE_FRAME) {
        return turned;
    }
    int got = t3r_recording_frame(self->recording, self->next, frame, capture->error, sizeof capture->error);
    uint32_t index = self->index++;
    self->next++;
    if (got != T3R_CAPTURE_FRAME) {
        return got;
    }
    self->first_ns = self->started ? self->first_ns : frame->stamp_ns;
    self->started = true;
    frame->stamp_ns += self->ago_ns;
    frame->depth_stamp_ns += self->ago_ns;
    frame->index = frame->sequence = index;
    capture->counts.paired += frame->frame.depth != NULL;
    return t3r_capture_deliver(capture, frame);
}

static void close_replay(t3r_capture *capture)
{
    replay *self = (replay *)capture;
    t3r_recording_close(self->recording);
    free(self);
}

t3r_capture *t3r_replay_open_repeated(const char *path, uint32_t times, char *error, size_t error_bytes)
{
    static const t3r_capture_operations operations = {next, NULL, close_replay};
    replay *self = calloc(1, sizeof *self);
    if (self == NULL) {
        t3r_reason(error, error_bytes, "%s: out of memory", path);
        return NULL;
    }
    self->capture.operations = &operations;
    self->capture.recorded = true;
    self->recording = t3r_recording_open(path, error, error_bytes);
    if (self->recording == NULL) {
        free(self);
        return NULL;
    }
    self->turns = times;
    t3r_reason(self->clock, sizeof self->clock, "%s", t3r_recording_clock(self->recording));
    self->capture.clock = self->clock;
    self->capture.depth_unit_q40 = t3r_recording_depth_unit_q40(self->recording);
    if (t3r_recording_note(self->recording)[0] != '\0') {
        t3r_capture_remark(&self->capture, "%s", t3r_recording_note(self->recording));
    }
    return &self->capture;
}

t3r_capture *t3r_replay_open_as(t3r_program program, const char *path, char *error, size_t error_bytes)
{
    return t3r_program_fits(program, t3r_capture_program(), error, error_bytes)
               ? t3r_replay_open_repeated(path, 1, error, error_bytes)
               : NULL;
}

static t3r_capture *open_source(const char *path, const t3r_capture_settings *settings, char *error, size_t error_bytes)
{
    return t3r_replay_open_repeated(path, settings->repeat, error, error_bytes);
}

const t3r_capture_source t3r_source_replay = {
    .name = "replay", .argument = "FILE", .says = "a recording, REC.mcap", .open = open_source};
