/* SPDX-License-Identifier: Apache-2.0 */
#include "stream.h"

#include <string.h>

#include <linux/usb/video.h>

#define HEADER_BYTES 2u /* of a payload, with neither PTS nor SCR: UVC 1.0, 2.4.3.3 */
#define INTERVAL_NS (INT64_C(100) * CAMERA_INTERVAL)

void stream_begin(stream *self, uint8_t format, int64_t now_ns)
{
    self->format = format;
    self->begun++;
    self->frame = self->sent = 0;
    self->due_ns = now_ns;
    self->stuck = false;
}

void stream_reset(stream *self)
{
    self->waiting_count = 0;
    self->stuck = true;
}

bool stream_ask(stream *self, const usbip_call *call)
{
    if (self->waiting_count == STREAM_MOST_WAITING) {
        return false;
    }
    self->waiting[self->waiting_count++] = *call;
    return true;
}

bool stream_forget(stream *self, uint32_t sequence)
{
    for (uint32_t i = 0; i < self->waiting_count; i++) {
        if (self->waiting[i].sequence == sequence) {
            self->waiting_count--;
            memmove(self->waiting + i, self->waiting + i + 1, sizeof self->waiting[0] * (self->waiting_count - i));
            return true;
        }
    }
    return false;
}

int64_t stream_next_ns(const stream *self)
{
    return self->waiting_count == 0 || self->stuck ? -1 : self->sent > 0 ? 0 : self->due_ns;
}

static picture picture_of(const stream *self)
{
    uint32_t number = STREAM_STEP * (self->begun - 1) + self->frame;
    const pictures *all = self->pictures;
    return self->format == CAMERA_MJPG ? all->jpeg[number % all->jpeg_count] : all->yuyv[number % all->yuyv_count];
}

static void end_frame(stream *self)
{
    self->frame++;
    self->sent = 0;
    self->due_ns += INTERVAL_NS;
}

stream_end stream_send(stream *self, int bus)
{
    static uint8_t payload[CAMERA_PAYLOAD_BYTES];
    fault_kind fault = faults_at(self->faults, self->begun - 1, self->frame);
    picture image = picture_of(self);
    uint32_t end = fault == FAULT_CUT ? image.count / 2 : image.count;
    if (fault == FAULT_STALL) {
        self->stuck = true;
        return STREAM_GOES_ON;
    }
    if ((fault == FAULT_UNPLUG || fault == FAULT_LEAVE) && (self->sent > 0 || end < CAMERA_PAYLOAD_BYTES)) {
        return fault == FAULT_UNPLUG ? STREAM_UNPLUG : STREAM_LEAVE;
    }
    usbip_call call = self->waiting[0];
    uint32_t room = call.bytes < sizeof payload ? call.bytes : (uint32_t)sizeof payload;
    if (room <= HEADER_BYTES || !stream_forget(self, call.sequence)) {
        return STREAM_BUS_GONE;
    }
    uint32_t count = end - self->sent < room - HEADER_BYTES ? end - self->sent : room - HEADER_BYTES;
    bool last = self->sent + count == end;
    payload[0] = HEADER_BYTES;
    payload[1] = (uint8_t)(UVC_STREAM_EOH | (self->frame % 2 != 0 ? UVC_STREAM_FID : 0) | (last ? UVC_STREAM_EOF : 0) |
                           (fault == FAULT_ERROR ? UVC_STREAM_ERR : 0));
    memcpy(payload + HEADER_BYTES, image.bytes + self->sent, count);
    self->sent += count;
    if (last) {
        end_frame(self);
    }
    return usbip_answer(bus, &call, payload, HEADER_BYTES + count) == 0 ? STREAM_GOES_ON : STREAM_BUS_GONE;
}
