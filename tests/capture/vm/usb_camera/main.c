/* SPDX-License-Identifier: Apache-2.0 */
/* usb_camera YUYV JPEGS [STREAM.FRAME=FAULT]...: plugs a camera into this machine's virtual USB bus, and sends images
 * of the files to any capture. FAULT is error, cut, stall, unplug or leave (faults.h). Ends after `leave`, or on a
 * signal, which unplugs it. */
#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "camera.h"
#include "descriptors.h"
#include "requests.h"
#include "stream.h"
#include "usbip.h"

#define AWAY_S 1 /* between unplugging and the next plug */
#define TRY_NS 50000000
#define MOST_TRIES 100 /* tries to plug in: the port is occupied until the kernel has noticed the unplugging */

static pictures images;
static faults planned;
static requests control;
static stream streaming = {.pictures = &images, .faults = &planned, .stuck = true};

static int64_t now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static int answer_control(int bus, const usbip_call *call, uint8_t *data)
{
    uint32_t room = call->bytes < DESCRIPTOR_MOST_BYTES ? call->bytes : DESCRIPTOR_MOST_BYTES;
    int count = request_answer(&control, call->setup, data, room);
    if (count == REQUEST_STALL) {
        return usbip_refuse(bus, call);
    }
    if (control.committed) {
        control.committed = false;
        stream_begin(&streaming, control.format, now_ns());
    }
    return usbip_answer(bus, call, data, call->in ? (uint32_t)count : call->bytes);
}

/* Handles one call of the host. Returns -1 if the bus is gone. */
static int serve(int bus)
{
    static uint8_t data[DESCRIPTOR_MOST_BYTES];
    usbip_call call;
    if (usbip_receive(bus, &call, data, sizeof data) != 0) {
        return -1;
    }
    if (call.unlink) {
        return usbip_unlinked(bus, &call, stream_forget(&streaming, call.unlinked));
    }
    if (call.endpoint == 0) {
        return answer_control(bus, &call, data);
    }
    bool asked = call.endpoint == CAMERA_ENDPOINT && call.in && stream_ask(&streaming, &call);
    return asked ? 0 : usbip_refuse(bus, &call);
}

/* Runs from plug to unplug. */
static stream_end live(int bus)
{
    stream_end end = STREAM_GOES_ON;
    stream_reset(&streaming);
    while (end == STREAM_GOES_ON) {
        int64_t next = stream_next_ns(&streaming), now = now_ns();
        int wait_ms = next < 0 ? -1 : next <= now ? 0 : (int)((next - now + 999999) / 1000000);
        struct pollfd host = {.fd = bus, .events = POLLIN};
        int ready = poll(&host, 1, wait_ms);
        if (ready < 0 && errno != EINTR) {
            return STREAM_BUS_GONE;
        }
        if (ready > 0) {
            end = serve(bus) == 0 ? STREAM_GOES_ON : STREAM_BUS_GONE;
        } else if (ready == 0) {
            end = stream_send(&streaming, bus);
        }
    }
    return end;
}

static int plug(void)
{
    int bus = usbip_plug();
    for (int tries = 0; bus < 0 && tries < MOST_TRIES; tries++) {
        nanosleep(&(struct timespec){0, TRY_NS}, NULL);
        bus = usbip_plug();
    }
    return bus;
}

int main(int argc, char **argv)
{
    if (argc < 3 || pictures_read(&images, argv[1], argv[2]) != 0) {
        fprintf(stderr, "usb_camera YUYV JPEGS [STREAM.FRAME=FAULT]...: the pictures cannot be read\n");
        return 2;
    }
    for (int i = 3; i < argc; i++) {
        if (faults_add(&planned, argv[i]) != 0) {
            fprintf(stderr, "usb_camera: %s is no fault, or one too many\n", argv[i]);
            return 2;
        }
    }
    for (;;) {
        int bus = plug();
        if (bus < 0) {
            fprintf(stderr, "usb_camera: cannot be plugged in: %s\n", strerror(errno));
            return 1;
        }
        stream_end end = live(bus);
        close(bus);
        if (end != STREAM_UNPLUG) {
            fprintf(stderr, "usb_camera: %s\n", end == STREAM_LEAVE ? "left" : "the bus is gone");
            return end == STREAM_LEAVE ? 0 : 1;
        }
        nanosleep(&(struct timespec){AWAY_S, 0}, NULL);
    }
}
