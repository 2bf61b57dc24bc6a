/* SPDX-License-Identifier: Apache-2.0 */
#include "descriptors.h"

#include <string.h>

#include <linux/usb/ch9.h>
#include <linux/usb/video.h>

#include "camera.h"
#include "little_endian.h"

/* A descriptor being written: it starts with its length, and a group's total is known at its end. */
typedef struct text {
    uint8_t *bytes;
    uint32_t count;
} text;

static void add(text *t, const uint8_t *bytes, uint32_t count)
{
    memcpy(t->bytes + t->count, bytes, count);
    t->count += count;
}

/* Adds a descriptor of the bytes after bLength. */
#define ADD(t, ...)                                                                                                    \
    add(t, (const uint8_t[]){1 + sizeof((const uint8_t[]){__VA_ARGS__}), __VA_ARGS__},                                 \
        1 + sizeof((const uint8_t[]){__VA_ARGS__}))

/* UVC 1.0, 3.7: a camera terminal whose images go to the streaming interface. */
static void add_control(text *t)
{
    ADD(t, USB_DT_INTERFACE, 0, 0, 0, USB_CLASS_VIDEO, UVC_SC_VIDEOCONTROL, 0, 0);
    uint32_t start = t->count;
    /* version 1.0, a clock of 48 MHz, one streaming interface */
    ADD(t, USB_DT_CS_INTERFACE, UVC_VC_HEADER, 0x00, 0x01, 0, 0, 0x00, 0x6c, 0xdc, 0x02, 1, CAMERA_STREAMING);
    /* UVC_ITT_CAMERA, without controls */
    ADD(t, USB_DT_CS_INTERFACE, UVC_VC_INPUT_TERMINAL, 1, 0x01, 0x02, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0);
    /* UVC_TT_STREAMING, fed by terminal 1 */
    ADD(t, USB_DT_CS_INTERFACE, UVC_VC_OUTPUT_TERMINAL, 2, 0x01, 0x01, 0, 1, 0);
    put_le(t->bytes + start + 5, t->count - start, 2);
}

/* Adds one size at one rate: UVC 1.0, Uncompressed Payload and MJPEG Payload, 3.1.2, which agree. */
static void add_frame(text *t, uint8_t subtype)
{
    uint8_t frame[30] = {sizeof frame, USB_DT_CS_INTERFACE, subtype, 1, 0};
    put_le(frame + 5, CAMERA_WIDTH, 2);
    put_le(frame + 7, CAMERA_HEIGHT, 2);
    put_le(frame + 9, CAMERA_YUYV_BYTES * 8 * CAMERA_RATE, 4); /* least and most bits a second */
    put_le(frame + 13, CAMERA_YUYV_BYTES * 8 * CAMERA_RATE, 4);
    put_le(frame + 17, CAMERA_YUYV_BYTES, 4);
    put_le(frame + 21, CAMERA_INTERVAL, 4);
    frame[25] = 1;
    put_le(frame + 26, CAMERA_INTERVAL, 4);
    add(t, frame, sizeof frame);
}

/* UVC 1.0, 3.9: both formats over one bulk endpoint, so there is no alternate setting to choose. */
static void add_streaming(text *t)
{
    ADD(t, USB_DT_INTERFACE, CAMERA_STREAMING, 0, 1, USB_CLASS_VIDEO, UVC_SC_VIDEOSTREAMING, 0, 0);
    uint32_t start = t->count;
    ADD(t, USB_DT_CS_INTERFACE, UVC_VS_INPUT_HEADER, 2, 0, 0, USB_DIR_IN | CAMERA_ENDPOINT, 0, 2, 0, 0, 0, 1, 0, 0);
    /* the GUID of YUY2, 16 bits a pixel: UVC 1.0, Uncompressed Payload, 3.1.1 */
    ADD(t, USB_DT_CS_INTERFACE, UVC_VS_FORMAT_UNCOMPRESSED, CAMERA_YUYV, 1, 'Y', 'U', 'Y', '2', 0x00, 0x00, 0x10, 0x00,
        0x80, 0x00, 0x00, 0xaa, 0x00, 0x38, 0x9b, 0x71, 16, 1, 0, 0, 0, 0);
    add_frame(t, UVC_VS_FRAME_UNCOMPRESSED);
    ADD(t, USB_DT_CS_INTERFACE, UVC_VS_COLORFORMAT, 1, 1, 4);
    ADD(t, USB_DT_CS_INTERFACE, UVC_VS_FORMAT_MJPEG, CAMERA_MJPG, 1, 0, 1, 0, 0, 0, 0);
    add_frame(t, UVC_VS_FRAME_MJPEG);
    ADD(t, USB_DT_CS_INTERFACE, UVC_VS_COLORFORMAT, 1, 1, 4);
    put_le(t->bytes + start + 4, t->count - start, 2);
    /* 512 bytes a packet: USB 2.0, 5.8.3 */
    ADD(t, USB_DT_ENDPOINT, USB_DIR_IN | CAMERA_ENDPOINT, USB_ENDPOINT_XFER_BULK, 0x00, 0x02, 0);
}

static void add_configuration(text *t)
{
    ADD(t, USB_DT_CONFIG, 0, 0, 2, 1, 0, USB_CONFIG_ATT_ONE, 50); /* fed by the bus, 100 mA */
    ADD(t, USB_DT_INTERFACE_ASSOCIATION, 0, 2, USB_CLASS_VIDEO, UVC_SC_VIDEO_INTERFACE_COLLECTION, 0, 0);
    add_control(t);
    add_streaming(t);
    put_le(t->bytes + 2, t->count, 2);
}

/* USB 2.0, 9.6.7: UTF-16; index 0 lists the languages, only US English. */
static void add_string(text *t, uint8_t index)
{
    static const char *const strings[] = {NULL, "trim3r", "test camera"};
    if (index == 0) {
        ADD(t, USB_DT_STRING, 0x09, 0x04);
    } else if (index < sizeof strings / sizeof strings[0]) {
        const char *string = strings[index];
        uint32_t letters = (uint32_t)strlen(string);
        add(t, (const uint8_t[]){(uint8_t)(2 + 2 * letters), USB_DT_STRING}, 2);
        for (uint32_t i = 0; i < letters; i++) {
            add(t, (const uint8_t[]){(uint8_t)string[i], 0}, 2);
        }
    }
}

uint32_t descriptor_get(uint8_t type, uint8_t index, uint8_t *out)
{
    text t = {out, 0};
    if (type == USB_DT_DEVICE) {
        /* USB 2.0; the class marks associated interfaces; pid.codes' number for tests; names 1 and 2 */
        ADD(&t, USB_DT_DEVICE, 0x00, 0x02, USB_CLASS_MISC, 2, 1, 64, 0x09, 0x12, 0x01, 0x00, 0x00, 0x01, 1, 2, 0, 1);
    } else if (type == USB_DT_CONFIG) {
        add_configuration(&t);
    } else if (type == USB_DT_STRING) {
        add_string(&t, index);
    }
    return t.count;
}
