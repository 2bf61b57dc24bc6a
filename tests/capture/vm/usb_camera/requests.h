/* SPDX-License-Identifier: Apache-2.0 */
/* Answers on the control pipe: standard requests (USB 2.0, 9.4), and the negotiation of a stream (UVC 1.0, 4.3.1.1). */
#ifndef T3R_TESTS_USB_REQUESTS_H
#define T3R_TESTS_USB_REQUESTS_H

#include <stdbool.h>
#include <stdint.h>

#define REQUEST_STALL (-1) /* answer to an unknown request: USB 2.0, 9.2.7 */

typedef struct requests {
    uint8_t probed, format; /* CAMERA_YUYV or CAMERA_MJPG: requested, agreed */
    bool committed;         /* a stream begins: the caller reads and clears it */
} requests;

/* Answers a request. `data` holds the request's data and has room for DESCRIPTOR_MOST_BYTES. Returns the bytes of the
 * answer, `length` at most, or REQUEST_STALL. */
int request_answer(requests *self, const uint8_t setup[8], uint8_t *data, uint32_t length);

#endif
