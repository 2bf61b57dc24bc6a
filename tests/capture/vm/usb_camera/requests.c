/* SPDX-License-Identifier: Apache-2.0 */
#include "requests.h"

#include <string.h>

#include <linux/usb/ch9.h>
#include <linux/usb/video.h>

#include "camera.h"
#include "descriptors.h"
#include "little_endian.h"

#define PROBE_BYTES 26u /* UVC 1.0, 4.3.1.1 */

static int answer(uint8_t *data, const uint8_t *bytes, uint32_t count, uint32_t length)
{
    count = count < length ? count : length;
    memmove(data, bytes, count);
    return (int)count;
}

static int standard(uint8_t request, uint16_t value, uint8_t *data, uint32_t length)
{
    uint8_t bytes[DESCRIPTOR_MOST_BYTES] = {0};
    switch (request) {
    case USB_REQ_GET_DESCRIPTOR: {
        uint32_t count = descriptor_get((uint8_t)(value >> 8), (uint8_t)value, bytes);
        return count != 0 ? answer(data, bytes, count, length) : REQUEST_STALL;
    }
    case USB_REQ_GET_STATUS:
        return answer(data, bytes, 2, length);
    case USB_REQ_GET_CONFIGURATION:
        bytes[0] = 1;
        return answer(data, bytes, 1, length);
    case USB_REQ_GET_INTERFACE:
        return answer(data, bytes, 1, length);
    case USB_REQ_CLEAR_FEATURE:
    case USB_REQ_SET_FEATURE:
    case USB_REQ_SET_CONFIGURATION:
    case USB_REQ_SET_INTERFACE:
        return 0;
    default:
        return REQUEST_STALL;
    }
}

/* Writes the only terms that the camera offers, apart from the format. */
static void terms(uint8_t format, uint8_t probe[PROBE_BYTES])
{
    memset(probe, 0, PROBE_BYTES);
    probe[0] = 1; /* bmHint: the interval is kept */
    probe[2] = format;
    probe[3] = 1;
    put_le(probe + 4, CAMERA_INTERVAL, 4);
    put_le(probe + 18, CAMERA_YUYV_BYTES, 4);
    put_le(probe + 22, CAMERA_PAYLOAD_BYTES, 4);
}

static int negotiation(requests *self, uint8_t request, uint8_t control, uint8_t *data, uint32_t length)
{
    uint8_t bytes[PROBE_BYTES] = {0};
    switch (request) {
    case UVC_SET_CUR:
        if (length < PROBE_BYTES) {
            return REQUEST_STALL;
        }
        self->probed = data[2] == CAMERA_MJPG ? CAMERA_MJPG : CAMERA_YUYV;
        if (control == UVC_VS_COMMIT_CONTROL) {
            self->format = self->probed;
            self->committed = true;
        }
        return 0;
    case UVC_GET_CUR:
    case UVC_GET_MIN:
    case UVC_GET_MAX:
    case UVC_GET_DEF:
        terms(request == UVC_GET_DEF || self->probed == 0 ? CAMERA_YUYV : self->probed, bytes);
        return answer(data, bytes, PROBE_BYTES, length);
    case UVC_GET_LEN:
        put_le(bytes, PROBE_BYTES, 2);
        return answer(data, bytes, 2, length);
    case UVC_GET_INFO:
        bytes[0] = UVC_CONTROL_CAP_GET | UVC_CONTROL_CAP_SET;
        return answer(data, bytes, 1, length);
    default:
        return REQUEST_STALL;
    }
}

int request_answer(requests *self, const uint8_t setup[8], uint8_t *data, uint32_t length)
{
    /* USB 2.0, 9.3 */
    uint8_t type = setup[0] & USB_TYPE_MASK, request = setup[1];
    uint16_t value = (uint16_t)get_le(setup + 2, 2), index = (uint16_t)get_le(setup + 4, 2);
    uint8_t control = (uint8_t)(value >> 8);
    if (type == USB_TYPE_STANDARD) {
        return standard(request, value, data, length);
    }
    if (type == USB_TYPE_CLASS && (index & 255) == CAMERA_STREAMING &&
        (control == UVC_VS_PROBE_CONTROL || control == UVC_VS_COMMIT_CONTROL)) {
        return negotiation(self, request, control, data, length);
    }
    return REQUEST_STALL;
}
