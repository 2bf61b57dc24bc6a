/* SPDX-License-Identifier: Apache-2.0 */
#include "usbip.h"

#include <arpa/inet.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <linux/usb/ch9.h>

#define PORT "/sys/devices/platform/vhci_hcd.0/attach"
#define HEADER_WORDS 12u /* of 32 bits, big-endian: usbip, "USBIP_CMD_SUBMIT" and following */

enum { CMD_SUBMIT = 1, CMD_UNLINK, RET_SUBMIT, RET_UNLINK };
enum { COMMAND, SEQUENCE, DEVICE, DIRECTION, ENDPOINT, FLAGS_OR_STATUS, LENGTH, SETUP = 10 };

static int whole(int bus, void *bytes, size_t count, bool sends)
{
    for (size_t at = 0; at < count;) {
        char *here = (char *)bytes + at;
        ssize_t done = sends ? send(bus, here, count - at, MSG_NOSIGNAL) : recv(bus, here, count - at, 0);
        if (done <= 0) {
            return -1;
        }
        at += (size_t)done;
    }
    return 0;
}

int usbip_plug(void)
{
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) {
        return -1;
    }
    /* port, socket, device 1 of bus 1: drivers/usb/usbip/vhci_sysfs.c, attach_store() */
    char line[64];
    int length = snprintf(line, sizeof line, "0 %d %d %d", ends[1], 1 << 16 | 1, USB_SPEED_HIGH);
    FILE *port = fopen(PORT, "w");
    bool plugged = port != NULL && fwrite(line, 1, (size_t)length, port) == (size_t)length;
    plugged = port != NULL && fclose(port) == 0 && plugged;
    int error = errno;
    close(ends[1]); /* the kernel holds its own */
    if (!plugged) {
        close(ends[0]);
        errno = error;
        return -1;
    }
    return ends[0];
}

int usbip_receive(int bus, usbip_call *call, uint8_t *data, uint32_t most)
{
    uint32_t header[HEADER_WORDS];
    if (whole(bus, header, sizeof header, false) != 0) {
        return -1;
    }
    uint32_t command = ntohl(header[COMMAND]);
    if (command != CMD_SUBMIT && command != CMD_UNLINK) {
        return -1;
    }
    *call = (usbip_call){.sequence = ntohl(header[SEQUENCE]), .unlink = command == CMD_UNLINK};
    if (call->unlink) {
        call->unlinked = ntohl(header[FLAGS_OR_STATUS]); /* the field after the common ones is the sequence */
        return 0;
    }
    call->in = header[DIRECTION] != 0;
    call->endpoint = ntohl(header[ENDPOINT]);
    call->bytes = ntohl(header[LENGTH]);
    memcpy(call->setup, header + SETUP, sizeof call->setup);
    if (call->in || call->bytes == 0) {
        return 0;
    }
    return call->bytes <= most ? whole(bus, data, call->bytes, false) : -1;
}

static int reply(int bus, const usbip_call *call, uint32_t command, int status, uint32_t bytes)
{
    uint32_t header[HEADER_WORDS] = {0};
    header[COMMAND] = htonl(command);
    header[SEQUENCE] = htonl(call->sequence);
    header[FLAGS_OR_STATUS] = htonl((uint32_t)status);
    header[LENGTH] = htonl(bytes);
    return whole(bus, header, sizeof header, true);
}

int usbip_answer(int bus, const usbip_call *call, const uint8_t *data, uint32_t bytes)
{
    if (reply(bus, call, RET_SUBMIT, 0, bytes) != 0) {
        return -1;
    }
    return call->in && bytes > 0 ? whole(bus, (void *)(uintptr_t)data, bytes, true) : 0;
}

int usbip_refuse(int bus, const usbip_call *call)
{
    return reply(bus, call, RET_SUBMIT, -EPIPE, 0);
}

int usbip_unlinked(int bus, const usbip_call *call, bool was_there)
{
    return reply(bus, call, RET_UNLINK, was_there ? -ECONNRESET : 0, 0);
}
