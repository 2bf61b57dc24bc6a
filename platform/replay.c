/* The adapter `replay`: a recording's frames, one after the other, as fast as they are asked for. */
#include <stdlib.h>

#include "capture_adapter.h"
#include "reason.h"
#include "recording.h"

typedef struct replay {
    t3r_capture capture; /* first: a t3r_capture * is a replay * */
    t3r_recording *recording;
    uint32_t next;
} replay;

/* A frame that cannot be read is a failure once; the call after it goes on with the next one. */
static int next(t3r_capture *capture, t3r_capture_frame *frame)
{
    replay *self = (replay *)capture;
    if (self->next == t3r_recording_frame_count(self->recording)) {
        return T3R_CAPTURE_END;
    }
    return t3r_recording_frame(self->recording, self->next++, frame, capture->error, sizeof capture->error);
}

static void close_replay(t3r_capture *capture)
{
    replay *self = (replay *)capture;
    t3r_recording_close(self->recording);
    free(self);
}

t3r_capture *t3r_replay_open(const char *path, char *error, size_t error_bytes)
{
    static const t3r_capture_operations operations = {next, close_replay};
    replay *self = calloc(1, sizeof *self);
    if (self == NULL) {
        t3r_reason(error, error_bytes, "%s: out of memory", path);
        return NULL;
    }
    self->capture.operations = &operations;
    self->recording = t3r_recording_open(path, error, error_bytes);
    if (self->recording == NULL) {
        free(self);
        return NULL;
    }
    return &self->capture;
}
