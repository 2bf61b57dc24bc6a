/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by all sources: counting, events, defaults. */
#include "trim3r_capture.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "capture_adapter.h"
#include "host/text.h"

int t3r_capture_next(t3r_capture *capture, t3r_capture_frame *frame)
{
    return capture->operations->next(capture, frame);
}

int t3r_capture_reopen(t3r_capture *capture)
{
    if (capture->operations->reopen == NULL) {
        return T3R_CAPTURE_END;
    }
    int result = capture->operations->reopen(capture);
    if (result == T3R_CAPTURE_FRAME) {
        capture->error[0] = '\0';
        t3r_capture_tell(capture, (t3r_capture_event){.kind = T3R_EVENT_REOPENED});
    }
    return result;
}

const char *t3r_capture_error(const t3r_capture *capture)
{
    return capture->error;
}

const char *t3r_capture_clock(const t3r_capture *capture)
{
    return capture->clock != NULL ? capture->clock : "unknown";
}

bool t3r_capture_recorded(const t3r_capture *capture)
{
    return capture->recorded;
}

const char *t3r_capture_note(const t3r_capture *capture)
{
    return capture->note;
}

uint64_t t3r_capture_depth_unit_q40(const t3r_capture *capture)
{
    return capture->depth_unit_q40;
}

t3r_capture_counts t3r_capture_counts_of(const t3r_capture *capture)
{
    return capture->counts;
}

void t3r_capture_listen(t3r_capture *capture, void (*hear)(void *user, const t3r_capture_event *event), void *user)
{
    capture->hear = hear;
    capture->hear_user = user;
}

void t3r_capture_close(t3r_capture *capture)
{
    if (capture != NULL) {
        capture->operations->close(capture);
    }
}

void t3r_capture_remark(t3r_capture *capture, const char *format, ...)
{
    size_t used = strlen(capture->note);
    if (used > 0 && used + 1 < sizeof capture->note) {
        capture->note[used++] = '\n';
    }
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(capture->note + used, sizeof capture->note - used, format, arguments);
    va_end(arguments);
    t3r_text_clean(capture->note + used);
}

void t3r_capture_tell(t3r_capture *capture, t3r_capture_event event)
{
    t3r_capture_counts *n = &capture->counts;
    uint64_t *const counted[T3R_EVENT_KIND_COUNT] = {
        [T3R_EVENT_PAIRED] = &n->paired,
        [T3R_EVENT_ALONE] = &n->alone,
        [T3R_EVENT_DEPTH_ALONE] = &n->depth_dropped,
        [T3R_EVENT_DROPPED_DRIVER] = &n->dropped_driver,
        [T3R_EVENT_DROPPED_SLOW] = &n->dropped_slow,
        [T3R_EVENT_DEPTH_DROPPED] = &n->depth_dropped,
        [T3R_EVENT_CORRUPTED] = &n->corrupted,
        [T3R_EVENT_FAULT] = &n->faults,
        [T3R_EVENT_REOPENED] = &n->reopened,
    };
    bool many = event.kind == T3R_EVENT_DROPPED_DRIVER || event.kind == T3R_EVENT_DROPPED_SLOW ||
                event.kind == T3R_EVENT_DEPTH_DROPPED;
    if (counted[event.kind] != NULL) {
        *counted[event.kind] += many ? event.count : 1;
    }
    if (capture->hear != NULL) {
        event.stamp_ns = event.stamp_ns != 0 ? event.stamp_ns : capture->last_stamp_ns;
        event.detail = event.detail != NULL ? event.detail : "";
        capture->hear(capture->hear_user, &event);
    }
}

int t3r_capture_lose(t3r_capture *capture, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(capture->error, sizeof capture->error, format, arguments);
    va_end(arguments);
    t3r_text_clean(capture->error);
    t3r_capture_tell(capture, (t3r_capture_event){.kind = T3R_EVENT_LOST, .detail = capture->error});
    return T3R_CAPTURE_LOST;
}

int t3r_capture_deliver(t3r_capture *capture, const t3r_capture_frame *frame)
{
    capture->counts.frames++;
    capture->last_stamp_ns = frame->stamp_ns;
    return T3R_CAPTURE_FRAME;
}

static uint32_t or_default(uint32_t value, uint32_t otherwise)
{
    return value != 0 ? value : otherwise;
}

const char *t3r_capture_settings_fill(const t3r_capture_settings *settings, t3r_capture_settings *filled)
{
    t3r_capture_settings s = settings != NULL ? *settings : (t3r_capture_settings){0};
    s.width = or_default(s.width, 640);
    s.height = or_default(s.height, 480);
    s.depth_width = or_default(s.depth_width, s.width);
    s.depth_height = or_default(s.depth_height, s.height);
    s.depth_unit_q40 = s.depth_unit_q40 != 0 ? s.depth_unit_q40 : T3R_DEFAULT_DEPTH_UNIT_Q40;
    s.buffers = or_default(s.buffers, 4);
    s.deadline_ms = or_default(s.deadline_ms, 100);
    s.stall_ms = or_default(s.stall_ms, 3000);
    s.pair_ms = or_default(s.pair_ms, 20);
    s.repeat = or_default(s.repeat, 1);
    *filled = s;
    const struct {
        uint32_t value, low, high;
        const char *wrong;
    } ranges[] = {
        {s.width, 2, T3R_MAX_SIDE, "the width is outside 2..4096"},
        {s.height, 2, T3R_MAX_SIDE, "the height is outside 2..4096"},
        {s.depth_width, 2, T3R_MAX_SIDE, "the depth's width is outside 2..4096"},
        {s.depth_height, 2, T3R_MAX_SIDE, "the depth's height is outside 2..4096"},
        {s.rate_millihertz, 0, 10000000, "the rate is outside 0..10000 frames a second"},
        {s.buffers, 2, 32, "the number of buffers is outside 2..32"},
        {s.deadline_ms, 1, 60000, "the deadline is outside 1..60000 ms"},
        {s.stall_ms, 1, 3600000, "the time of standing still is outside 1 ms..1 h"},
        {s.pair_ms, 1, 1000, "the distance of pairs is outside 1..1000 ms"},
    };
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
        if (ranges[i].value < ranges[i].low || ranges[i].value > ranges[i].high) {
            return ranges[i].wrong;
        }
    }
    return s.depth_unit_q40 >> 47 != 0 ? "the depth unit is not below 2^7" : NULL;
}

const char *t3r_capture_event_text(const t3r_capture_event *event, char text[T3R_CAPTURE_EVENT_BYTES])
{
    size_t room = T3R_CAPTURE_EVENT_BYTES;
    double gap_ms = (double)event->gap_ns * 1e-6;
    switch (event->kind) {
    case T3R_EVENT_PAIRED:
        snprintf(text, room, "colour %" PRIu32 " with depth %" PRIu32 ", %+.3f ms", event->sequence,
                 event->depth_sequence, gap_ms);
        break;
    case T3R_EVENT_ALONE:
        if (event->gap_ns == INT64_MAX) {
            snprintf(text, room, "colour %" PRIu32 " without depth: none came", event->sequence);
        } else {
            snprintf(text, room, "colour %" PRIu32 " without depth: the nearest is %+.3f ms away", event->sequence,
                     gap_ms);
        }
        break;
    case T3R_EVENT_DEPTH_ALONE:
        snprintf(text, room, "depth %" PRIu32 " without colour", event->depth_sequence);
        break;
    case T3R_EVENT_DROPPED_DRIVER:
        snprintf(text, room, "%" PRIu64 " dropped by the driver before colour %" PRIu32, event->count, event->sequence);
        break;
    case T3R_EVENT_DROPPED_SLOW:
        snprintf(text, room, "%" PRIu64 " dropped before colour %" PRIu32 ": frames were fetched too slowly",
                 event->count, event->sequence);
        break;
    case T3R_EVENT_DEPTH_DROPPED:
        snprintf(text, room, "%" PRIu64 " dropped before depth %" PRIu32, event->count, event->depth_sequence);
        break;
    case T3R_EVENT_CORRUPTED:
        snprintf(text, room, "frame %" PRIu32 " left out: %.200s", event->sequence, event->detail);
        break;
    case T3R_EVENT_REOPENED:
        snprintf(text, room, "opened again");
        break;
    case T3R_EVENT_FAULT:
    case T3R_EVENT_LOST:
    case T3R_EVENT_KIND_COUNT:
    default:
        snprintf(text, room, "%.250s", event->detail);
        break;
    }
    return text;
}
