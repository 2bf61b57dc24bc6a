/* SPDX-License-Identifier: Apache-2.0 */
/* Chooses a device's format for capture: one that the runtime reads, at the wished size and rate if possible. */
#ifndef T3R_PLATFORM_V4L2_FORMAT_H
#define T3R_PLATFORM_V4L2_FORMAT_H

#include <stdbool.h>
#include <stdint.h>

#include <linux/videodev2.h>

#include "trim3r.h"
#include "v4l2_system.h"

typedef struct t3r_v4l2_format {
    const char *name; /* its FourCC */
    uint32_t fourcc;
    t3r_pixel_format pixels; /* depth: none; MJPG: the decoded format */
    bool depth, jpeg;
} t3r_v4l2_format;

/* The formats of this build in order of preference: raw before compressed, colour before grey. */
extern const t3r_v4l2_format t3r_v4l2_formats[];
extern const uint32_t t3r_v4l2_format_count;

/* Makes an ioctl; repeats it if a signal interrupts it, at most 16 times. */
int t3r_v4l2_ioctl(const t3r_v4l2_system *system, int fd, unsigned long request, void *argument);

typedef struct t3r_v4l2_wish {
    bool depth;
    const char *format; /* a FourCC; NULL = any */
    uint32_t width, height, rate_millihertz;
} t3r_v4l2_wish;

typedef struct t3r_v4l2_choice {
    const t3r_v4l2_format *format;
    uint32_t width, height; /* as enumerated; the driver may still change it */
} t3r_v4l2_choice;

/* Chooses the format with the nearest size; among equals one that reaches the rate; then the most preferred. Returns
 * NULL, or why there is none. */
const char *t3r_v4l2_choose(const t3r_v4l2_system *system, int fd, const t3r_v4l2_wish *wish, t3r_v4l2_choice *choice);

#endif
