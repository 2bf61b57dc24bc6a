/* SPDX-License-Identifier: Apache-2.0 */
/* The virtual bus: a socket whose other end is a port of the kernel's vhci_hcd (usbip). */
#ifndef T3R_TESTS_USBIP_H
#define T3R_TESTS_USBIP_H

#include <stdbool.h>
#include <stdint.h>

/* A request of the host. */
typedef struct usbip_call {
    uint32_t sequence; /* repeated in the answer */
    bool unlink;       /* cancels the call `unlinked`; otherwise a transfer */
    uint32_t unlinked;
    bool in; /* to the host */
    uint32_t endpoint;
    uint32_t bytes; /* bytes sent by the host, or the room for the answer */
    uint8_t setup[8];
} usbip_call;

/* Plugs a high-speed device into port 0. Returns the socket, or -1 with errno. Closing the socket unplugs the
 * device. */
int usbip_plug(void);
/* Receives the next call and its data into data[most]. Returns 0, or -1 if the bus is gone or the call is larger. */
int usbip_receive(int bus, usbip_call *call, uint8_t *data, uint32_t most);
/* Completes a transfer: `bytes` were sent or taken; if `in`, they are in data. */
int usbip_answer(int bus, const usbip_call *call, const uint8_t *data, uint32_t bytes);
/* Refuses a transfer: the endpoint stalls. */
int usbip_refuse(int bus, const usbip_call *call);
/* Answers `unlink` with whether that call was still pending. */
int usbip_unlinked(int bus, const usbip_call *call, bool was_there);

#endif
