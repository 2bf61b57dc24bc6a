#include "requests.h"

#include <string.h>

#include "camera.h"
#include "descriptors.h"
#include "little_endian.h"

#define PROBE_BYTES 26u /* UVC 1.0, table 4-47 */

/* USB 2.0, table 9-4 */
enum {
    GET_STATUS = 0,
    CLEAR_FEATURE = 1,
    SET_FEATURE = 3,
    GET_DESCRIPTOR = 6,
    GET_CONFIGURATION = 8,
    SET_CONFIGURATION = 9,
    GET_INTERFACE = 10,
    SET_INTERFACE = 11
};
/* UVC 1.0, A.8 */
enum { SET_CUR = 0x01, GET_CUR = 0x81, GET_MIN, GET_MAX, GET_RES, GET_LEN, GET_INFO, GET_DEF };
/* UVC 1.0, A.9.7 */
enum { VS_PROBE = 1, VS_COMMIT };

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
    case GET_DESCRIPTOR: {
        uint32_t count = descriptor_get((uint8_t)(value >> 8), (uint8_t)value, bytes);
        return count != 0 ? answer(data, bytes, count, length) : REQUEST_STALL;
    }
    case GET_STATUS:
        return answer(data, bytes, 2, length);
    case GET_CONFIGURATION:
        bytes[0] = 1;
        return answer(data, bytes, 1, length);
    case GET_INTERFACE:
        return answer(data, bytes, 1, length);
    case CLEAR_FEATURE:
    case SET_FEATURE:
    case SET_CONFIGURATION:
    case SET_INTERFACE:
        return 0;
    default:
        return REQUEST_STALL;
    }
}

/* The only terms that there are, but for the format. */
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
    case SET_CUR:
        if (length < PROBE_BYTES) {
            return REQUEST_STALL;
        }
        self->probed = data[2] == CAMERA_MJPG ? CAMERA_MJPG : CAMERA_YUYV;
        if (control == VS_COMMIT) {
            self->format = self->probed;
            self->committed = true;
        }
        return 0;
    case GET_CUR:
    case GET_MIN:
    case GET_MAX:
    case GET_DEF:
        terms(request == GET_DEF || self->probed == 0 ? CAMERA_YUYV : self->probed, bytes);
        return answer(data, bytes, PROBE_BYTES, length);
    case GET_LEN:
        put_le(bytes, PROBE_BYTES, 2);
        return answer(data, bytes, 2, length);
    case GET_INFO:
        bytes[0] = 3; /* can be read and set: UVC 1.0, table 4-3 */
        return answer(data, bytes, 1, length);
    default:
        return REQUEST_STALL;
    }
}

int request_answer(requests *self, const uint8_t setup[8], uint8_t *data, uint32_t length)
{
    /* USB 2.0, table 9-2 */
    uint8_t type = setup[0] >> 5 & 3, request = setup[1];
    uint16_t value = (uint16_t)get_le(setup + 2, 2), index = (uint16_t)get_le(setup + 4, 2);
    uint8_t control = (uint8_t)(value >> 8);
    if (type == 0) {
        return standard(request, value, data, length);
    }
    if (type == 1 && (index & 255) == CAMERA_STREAMING && (control == VS_PROBE || control == VS_COMMIT)) {
        return negotiation(self, request, control, data, length);
    }
    return REQUEST_STALL;
}
