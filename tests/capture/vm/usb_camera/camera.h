/* SPDX-License-Identifier: Apache-2.0 */
/* A camera of the USB Video Class (UVC), as a program: what its parts agree on.
 *
 * Sources, named where they are used: "USB 2.0", Universal Serial Bus Specification 2.0; "UVC 1.0", USB Device Class
 * Definition for Video Devices 1.0 with its payload papers (1.1 keeps the numbers of the sections; 1.5 has a longer
 * probe control, a few later sections shifted); "usbip", the Linux kernel's Documentation/usb/usbip_protocol.rst.
 * Constants are those of <linux/usb/ch9.h> and <linux/usb/video.h>, which name their sections. */
#ifndef T3R_TESTS_USB_CAMERA_H
#define T3R_TESTS_USB_CAMERA_H

#include <stdint.h>

enum {
    CAMERA_WIDTH = 160,
    CAMERA_HEIGHT = 120,
    CAMERA_RATE = 30,
    CAMERA_INTERVAL = 10000000 / CAMERA_RATE,             /* 100 ns */
    CAMERA_YUYV_BYTES = CAMERA_WIDTH * CAMERA_HEIGHT * 2, /* bytes of an image, also the maximum of a JPEG */
    CAMERA_PAYLOAD_BYTES = 16384,                         /* a payload with its header: one transfer */
    CAMERA_ENDPOINT = 1,                                  /* the endpoint of images */
    CAMERA_STREAMING = 1,                                 /* the interface of the endpoint */
};

/* bFormatIndex of the formats' descriptors. */
enum { CAMERA_YUYV = 1, CAMERA_MJPG };

#endif
